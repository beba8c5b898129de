#pragma once

/// Input and output of every flow scheme: coefficients in, volumes through faces out.

#include <vector>

#include "grid/element_field.hpp"
#include "results/state_archive.hpp"

namespace suffuse {

template <int Dim>
using VectorField = std::vector<Vector<Dim>>;

/// The pores as the flow sees them. All per element unless noted.
template <int Dim>
struct FlowCoefficients {
  std::vector<double> porosity;         ///< n_L
  std::vector<double> water_volume;     ///< pore volume minus fluidised fines, m3
  std::vector<double> mixture_density;  ///< rho_L, kg/m3
  std::vector<double> drag;             ///< on the liquid, divided by n_L, kg/(m3 s)
  /// Drag of fast flow: b in the pressure gradient b |q| q, kg/m4 (Ergun). Empty if no soil has
  /// quadratic drag.
  std::vector<double> quadratic_drag;
  std::vector<double> face_concentration;  ///< per face: c of the liquid that crosses it

  void archive(auto& archive) {
    archive(on_elements(porosity), on_elements(water_volume), on_elements(mixture_density),
            on_elements(drag), on_elements(quadratic_drag), on_faces(face_concentration));
  }
};

/// Volumes that crossed the faces of the grid over an interval of time, along each face's normal.
struct FaceVolumes {
  std::vector<double> liquid;  ///< volume of liquid, m3
  /// Volume of liquid weighted with rho_w / rho_w0 - 1 of the water that crossed, m3. The sum of
  /// this and `liquid`, times 1 - c, is the mass of water over rho_w0.
  std::vector<double> density_excess;
};

}  // namespace suffuse
