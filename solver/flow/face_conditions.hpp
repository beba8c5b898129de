#pragma once

/// Boundary conditions face by face: what the scene prescribes at each face of the grid, and when
/// it changes.

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

  /// Its kind and place are the scene's.
  void archive(auto& archive) { archive(value, concentration); }
  /// The flux through the face is prescribed, zero included.
  [[nodiscard]] bool fixes_flux() const {
    return kind == FaceKind::wall || kind == FaceKind::velocity || kind == FaceKind::flux;
  }
};

/// Per face of the grid, with the values at t = 0. Throws InputError when a condition names no
/// boundary of the mesh or two conditions meet on one face.
template <int Dim>
std::vector<FaceCondition> face_conditions(const Case<Dim>& c, const Grid<Dim>& grid);

/// Boundary conditions whose values change in time; their kinds do not.
template <int Dim>
class BoundaryValues {
 public:
  /// Throws as `face_conditions` does.
  BoundaryValues(const Case<Dim>& c, const Grid<Dim>& grid);

  /// Per face of the grid, at a time in s.
  [[nodiscard]] std::vector<FaceCondition> at(double time) const;
  /// The same in place: `conditions` come from `at` or `face_conditions` of the same case, at any
  /// time. Touches the faces of boundaries that change in time and no others.
  void update(double time, std::vector<FaceCondition>& conditions) const;
  /// Concentrations of another time alone, in place: what entered over an interval has that of its
  /// middle, which is the mean wherever it is linear.
  void update_concentrations(double time, std::vector<FaceCondition>& conditions) const;
  /// Whether any value changes in time.
  [[nodiscard]] bool vary() const { return !varying_.empty(); }
  /// Times at which a value that changes may have a kink, in (0, end), s: ascending, each once.
  /// Between two of them every value is linear in time.
  [[nodiscard]] const std::vector<double>& breakpoints() const { return breakpoints_; }

 private:
  struct Varying {
    BoundaryCondition boundary;
    int index = -1;  ///< of the scene's boundary entry
    std::vector<int> faces;
  };

  std::vector<FaceCondition> initial_;
  std::vector<Varying> varying_;
  std::vector<double> breakpoints_;
};

}  // namespace suffuse
