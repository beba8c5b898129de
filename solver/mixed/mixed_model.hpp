#pragma once

/// Input and output of a flow by mixed elements: the model, common to all steps, and the forcing
/// and the state of a step.

#include <algorithm>
#include <cmath>
#include <vector>

#include "boundary/face_conditions.hpp"
#include "boundary/leaky_walls.hpp"
#include "common/errors.hpp"
#include "mixed/flow_soils.hpp"
#include "physics/numbers.hpp"
#include "scene/scene.hpp"

namespace suffuse {

struct ImplicitSettings {
  double bulk_modulus = infinity;  ///< K, Pa; may be infinite
  bool inertia = false;            ///< keep rho_L dv/dt
  TimeStepping stepping = TimeStepping::second_order;
  int threads = 1;
};

template <int Dim>
struct MixedState {
  std::vector<double> face_pressure;  ///< at face centers, Pa
  VectorField<Dim> velocity;          ///< mean of each element, intrinsic, m/s
  /// Volume of air in the share of each side of an element, m3; empty where all soil is saturated.
  ElementField<Dim> air = {};

  void archive(auto& archive) {
    archive(on_faces(face_pressure), on_elements(velocity), on_elements(air));
  }
};

/// The conditions and coefficients of the flow at one moment.
template <int Dim>
struct FlowForcing {
  FlowCoefficients<Dim> coefficients;
  std::vector<FaceCondition> conditions;  ///< per face
  /// Per element: liquid that leaves it beyond what it stores, m3/s. Empty: none.
  std::vector<double> source;
  /// Additional storage per element, m3/Pa, of the rise of its mean pressure above `known_rise`,
  /// Pa. Empty: none.
  std::vector<double> mean_storage = {};
  std::vector<double> known_rise = {};
  /// Additional mobility per element from the soil's inertia, m3 s/kg. It multiplies the difference
  /// between two pressure gradients: the one after `expected_rise` and the actual one. Empty: none;
  /// not with quadratic drag.
  std::vector<double> mean_mobility = {};
  /// Expected in the step, per face, Pa. Where soil retains liquid, iterations start from it.
  std::vector<double> expected_rise = {};
  /// Force on the liquid in addition to its weight, per element, N/m3. Empty: none.
  VectorField<Dim> force = {};
  /// Share of the first residual at which Newton's method may end; 0: at its own accuracy.
  double reduction = 0.0;
};

/// The nonlinear iteration of a step did not converge; that of a shorter step may.
class NotConverged : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

template <int Dim>
struct MixedStep {
  MixedState<Dim> end;
  std::vector<double> face_volume;  ///< over the step, along each face's normal, m3
  std::vector<double> face_flux;    ///< at the end, along each face's normal, m3/s
  /// `face_flux` without what faces with a prescribed pressure store in their share of an element.
  /// `face_flux` jumps where the pressure has a kink in time, `flux_through` does not.
  std::vector<double> flux_through;
};

template <int Dim>
struct MixedModel {
  const Grid<Dim>& grid;
  ImplicitSettings settings;
  Vector<Dim> gravity;
  FlowSoils<Dim> soils;
  std::vector<LeakyFace> walls;
  std::vector<double> face_area = {};  ///< m2

  [[nodiscard]] bool has_retention() const { return !soils.saturated(); }

  /// Largest magnitude at the faces of an element.
  [[nodiscard]] double largest_at_faces(int e, const std::vector<double>& face_values) const {
    double largest = 0.0;
    for (const int f : grid.element_face[e]) largest = std::max(largest, std::abs(face_values[f]));
    return largest;
  }
  /// Gradient of the sum of two pressures at the faces of an element, Pa/m.
  [[nodiscard]] Vector<Dim> pressure_gradient(int e, const std::vector<double>& reference,
                                              const std::vector<double>& rise) const {
    // Differences first: the normals add up to zero, so the level of the pressure cancels.
    const auto& faces = grid.element_face[e];
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (int k = 1; k <= Dim; ++k) {
      const double difference =
          (reference[faces[k]] - reference[faces[0]]) + (rise[faces[k]] - rise[faces[0]]);
      sum += difference * grid.outward_normal(e, k);
    }
    return sum / grid.volume[e];
  }
  /// Flux through the largest side of a saturated element under gravity alone, m3/s.
  [[nodiscard]] double gravity_flux(int e, const FlowCoefficients<Dim>& c) const {
    const double best = soils.bedding.empty() ? 1.0 : soils.bedding[e].largest_eigenvalue();
    return c.mixture_density[e] * gravity.norm() * c.porosity[e] / c.drag[e] * best *
           largest_at_faces(e, face_area);
  }
};

}  // namespace suffuse
