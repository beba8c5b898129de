#pragma once

/// What bounds and estimates start from: the flow of a scene at one moment.

#include <vector>

#include "mixed/implicit_mixed.hpp"
#include "scene/scene.hpp"

namespace suffuse {

/// Largest errors of the last step.
struct LastStepErrors {
  // Errors of the step in time, at its end; empty where they are not known.
  std::vector<double> face_pressure = {};  ///< Pa
  std::vector<double> face_flux = {};      ///< along the faces' normals, m3/s
  /// Relative change of each element's conductivity by erosion and transport, after the flow was
  /// solved; empty where it is not known.
  std::vector<double> conductivity = {};

  void archive(auto& archive) {
    archive(on_faces(face_pressure), on_faces(face_flux), on_elements(conductivity));
  }
};

/// A flow by mixed elements, as it is at one moment.
template <int Dim>
struct SeepageState {
  const Grid<Dim>& grid;
  const Scene& scene;
  const FlowCoefficients<Dim>& coefficients;
  const std::vector<FaceCondition>& conditions;
  const FlowSoils<Dim>& soils;
  const std::vector<LeakyFace>& walls;
  const std::vector<double>& face_pressure;   ///< Pa
  const std::vector<double>& face_flux;       ///< along the faces' normals, m3/s
  std::vector<double> relative_conductivity;  ///< per element; empty where all is saturated
  int threads = 1;
  LastStepErrors step = {};
};

}  // namespace suffuse
