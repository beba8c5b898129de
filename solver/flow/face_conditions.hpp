#pragma once

/// What the scene's boundary conditions say of each face of the grid.

#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "grid/grid.hpp"

namespace suffuse {

enum class FaceKind : unsigned char {
  interior,
  wall,      ///< impervious
  pressure,  ///< value: Pa
  velocity,  ///< value: intrinsic liquid velocity into the model, m/s
  flux,      ///< value: Darcy flux into the model, m/s
};

struct FaceCondition {
  FaceKind kind = FaceKind::interior;
  double value = 0.0;
  double concentration = 0.0;        ///< c of liquid that enters
  bool concentration_given = false;  ///< else clean water enters, and the run says so
  int boundary = -1;                 ///< index of the scene's boundary entry

  /// The flux through the face is prescribed, zero included.
  [[nodiscard]] bool fixes_flux() const {
    return kind == FaceKind::wall || kind == FaceKind::velocity || kind == FaceKind::flux;
  }
};

/// Per face of the grid. Throws InputError when a condition names no boundary of the mesh or two
/// conditions meet on one face.
template <int Dim>
std::vector<FaceCondition> face_conditions(const Case<Dim>& c, const Grid<Dim>& grid);

}  // namespace suffuse
