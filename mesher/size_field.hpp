#pragma once

/// Sizes of elements at any place, from those at the nodes of a mesh.

#include <vector>

#include "case/mesh_sizes.hpp"

namespace suffuse {

/// Finds elements by a tree of boxes, each of which holds the elements of its two branches.
template <int Dim>
class SizeField {
 public:
  explicit SizeField(MeshSizes<Dim> sizes);

  /// Linear in each element. Outside of the mesh, as beyond the chord of a curved boundary, it is
  /// the size at a place of the mesh nearby.
  [[nodiscard]] double at(const Vector<Dim>& x) const;

 private:
  struct Box {
    Vector<Dim> low;
    Vector<Dim> high;
    int begin;  ///< in `order_`
    int end;
    int branch = 0;  ///< index of the second branch; the first one is next; 0: no branches
  };
  /// The place of the mesh that is nearest so far.
  struct Nearest {
    double distance;  ///< squared
    double size;
  };

  int add_box(int begin, int end);
  void search(int box, const Vector<Dim>& x, Nearest& nearest) const;
  void try_element(int element, const Vector<Dim>& x, Nearest& nearest) const;

  MeshSizes<Dim> sizes_;
  std::vector<int> order_;  ///< elements, those of each box in a row
  std::vector<Box> boxes_;
};

}  // namespace suffuse
