#pragma once

/// The matrix of the mixed elements: symmetric, with an unknown for each face whose pressure is not
/// prescribed throughout. Its entries are T N_a . N_b / V of each element, plus storage on the
/// diagonal. The two sides of a wall that lets liquid through are coupled by its conductance.

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "boundary/leaky_walls.hpp"
#include "grid/element_field.hpp"
#include "grid/grid.hpp"
#include "mixed/directional_factor.hpp"
#include "mixed/flow.hpp"

namespace suffuse {

/// The linear law q = mobility factor (drive - grad p) of each element.
template <int Dim>
struct MomentumLaw {
  std::vector<double> mobility;                ///< T, m3 s/kg
  std::vector<DirectionalFactor<Dim>> factor;  ///< of bedding and fast flow; empty: I everywhere
  VectorField<Dim> drive;                      ///< Pa/m

  /// The flux that a push in Pa/m makes, over the mobility.
  [[nodiscard]] Vector<Dim> directed(int e, const Vector<Dim>& push) const {
    return factor.empty() ? push : factor[e].times(push);
  }
};

template <int Dim>
class MixedMatrix {
 public:
  MixedMatrix(const Grid<Dim>& grid, int threads);

  /// Numbers the unknowns and lays out the pattern. `kinds`: per face, for the whole run.
  void lay_out(const std::vector<FaceKind>& kinds);
  [[nodiscard]] int unknowns() const { return unknowns_; }
  /// Number of a face's unknown; -1 where its pressure is prescribed throughout.
  [[nodiscard]] int unknown(int face) const { return unknown_[face]; }

  /// Values for a law and for the storage of each element at each of its faces, m3/(s Pa):
  /// `storage` per element, in addition `side_storage` per side of an element, and `mean_storage`
  /// with the mean pressure of an element (both may be empty).
  void assemble(const MomentumLaw<Dim>& law, const std::vector<double>& storage,
                const ElementField<Dim>& side_storage = {},
                const std::vector<double>& mean_storage = {});
  /// Couples the faces of a wall, after `assemble`: conductance times the difference of their
  /// pressures flows between them.
  void couple(const LeakyFace& wall);
  /// Makes the unknown of a face one of its own, uncoupled from the others, whose value the right
  /// side decides.
  void uncouple(int face);
  /// The values, with what the conductivity of an element gains as the pressure at its sides rises:
  /// `flux` out of it by each side, m3/s, grows by the share `gain` per pressure, 1/Pa. What that
  /// adds to the diagonal, where liquid enters, was assembled already. Faces that are `held` keep
  /// their uncoupled rows. No longer symmetric.
  [[nodiscard]] Eigen::SparseMatrix<double> with_gain(const ElementField<Dim>& flux,
                                                      const ElementField<Dim>& gain,
                                                      const std::vector<char>& held) const;
  /// Doubles the diagonal at the first face of an element, where nothing else holds the level of
  /// the pressure: its rise is then zero, as the rest of the system adds up to zero.
  void hold_level(int element) { values_.valuePtr()[position_[element][0][0]] *= 2.0; }
  [[nodiscard]] const Eigen::SparseMatrix<double>& values() const { return values_; }

  /// Largest N . N / V of an element, 1/m2 times m2.
  [[nodiscard]] double largest_product(int element) const;

 private:
  template <class Value>
  using PerEntry = std::vector<std::array<std::array<Value, Dim + 1>, Dim + 1>>;

  /// Where an entry is among the values.
  [[nodiscard]] int position(int row, int column) const;
  [[nodiscard]] double entry(const MomentumLaw<Dim>& law, int e, int a, int b) const;

  const Grid<Dim>& grid_;
  int threads_;
  std::vector<int> unknown_;
  int unknowns_ = 0;
  Eigen::SparseMatrix<double> values_;
  PerEntry<int> position_;     ///< where an element's entry goes among the values; -1 for none
  PerEntry<double> products_;  ///< N_a . N_b / V
};

}  // namespace suffuse
