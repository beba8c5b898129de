#include "flow/explicit_nodal.hpp"

namespace suffuse {
namespace {

/// Below this many entities a loop is shorter than waking the threads.
constexpr int worth_threads = 8192;

/// rho_w / rho_w0 - 1 at a pressure small against K; the exact value is restored with the masses.
double density_excess(double pressure_over_modulus) {
  const double x = pressure_over_modulus;
  return x * (1.0 + 0.5 * x * (1.0 + x / 3.0));
}

}  // namespace

template <int Dim>
ExplicitNodal<Dim>::ExplicitNodal(const NodalOperator<Dim>& op, ExplicitSettings settings)
    : operator_(op),
      settings_(settings),
      pressure_(op.grid().mesh.element_count(), 0.0),
      velocity_(op.grid().mesh.node_count(), Vector<Dim>::Zero()),
      previous_velocity_(velocity_),
      face_flux_(op.grid().face_count(), 0.0),
      upwind_pressure_(op.grid().face_count(), 0.0) {
  reset_volumes();
}

template <int Dim>
void ExplicitNodal<Dim>::update(const FlowCoefficients<Dim>& coefficients) {
  const auto elements = coefficients.water_volume.size();
  element_weight_.resize(elements);
  for (std::size_t e = 0; e < elements; ++e) {
    const double carried = settings_.porosity_gradient_term ? 1.0 : coefficients.porosity[e];
    element_weight_[e] = carried / coefficients.water_volume[e];
  }
  carried_water_share_.resize(coefficients.face_concentration.size());
  for (std::size_t f = 0; f < carried_water_share_.size(); ++f) {
    carried_water_share_[f] = 1.0 - coefficients.face_concentration[f];
  }
}

template <int Dim>
void ExplicitNodal<Dim>::step(double dt) {
  previous_velocity_ = velocity_;
  velocity_spacing_ = 0.5 * (last_dt_ + dt);
  accelerate(velocity_spacing_);
  cross_faces(dt);
  for (std::size_t i = 0; i < displacement_.size(); ++i) displacement_[i] += dt * velocity_[i];
  compress(dt);
  last_dt_ = dt;
}

template <int Dim>
void ExplicitNodal<Dim>::accelerate(double dt) {
  const bool implicit_drag = settings_.drag == DragIntegration::implicit_drag;
  const std::vector<double>& quadratic = operator_.node_quadratic_drag();
  const int nodes = operator_.grid().mesh.node_count();
#pragma omp parallel for schedule(static) num_threads(settings_.threads) if (nodes > worth_threads)
  for (int i = 0; i < nodes; ++i) {
    const double rate = dt / (settings_.mass_scaling * operator_.node_mass()[i]);
    double drag = operator_.node_drag()[i];
    if (!quadratic.empty()) drag += quadratic[i] * velocity_[i].norm();
    const double damping = rate * drag;
    const Vector<Dim> push = rate * operator_.force(i, pressure_);
    if (implicit_drag) {
      velocity_[i] = (velocity_[i] + push) / (1.0 + damping);
    } else {
      velocity_[i] += push - damping * velocity_[i];
    }
  }
  operator_.constrain(velocity_);
}

template <int Dim>
void ExplicitNodal<Dim>::cross_faces(double dt) {
  const Grid<Dim>& grid = operator_.grid();
  const auto& conditions = operator_.conditions();
  const int faces = grid.face_count();
#pragma omp parallel for schedule(static) num_threads(settings_.threads) if (faces > worth_threads)
  for (int f = 0; f < faces; ++f) {
    const double flux = operator_.face_flux(f, velocity_);
    const int right = grid.face_right[f];
    double upwind = pressure_[grid.face_left[f]];
    if (flux < 0.0) {
      if (right >= 0) {
        upwind = pressure_[right];
      } else if (conditions[f].kind == FaceKind::pressure) {
        upwind = conditions[f].value;
      }
    }
    face_flux_[f] = flux;
    upwind_pressure_[f] = upwind;
    volumes_.liquid[f] += dt * flux;
    volumes_.density_excess[f] += dt * flux * density_excess(upwind / settings_.bulk_modulus);
  }
}

template <int Dim>
void ExplicitNodal<Dim>::compress(double dt) {
  const Grid<Dim>& grid = operator_.grid();
  const double modulus = settings_.bulk_modulus;
  const double convected = settings_.pressure_moves_with_liquid ? 0.0 : 1.0 / modulus;
  const int elements = grid.mesh.element_count();
#pragma omp parallel for schedule(static) \
    num_threads(settings_.threads) if (elements > worth_threads)
  for (int e = 0; e < elements; ++e) {
    double outflow = 0.0;
    for (int k = 0; k <= Dim; ++k) {
      const int f = grid.element_face[e][k];
      const double heavier = carried_water_share_[f] * (upwind_pressure_[f] - pressure_[e]);
      outflow += grid.element_face_sign[e][k] * face_flux_[f] * (1.0 + convected * heavier);
    }
    // ln(1 - x) to second order: the density's own increment, not only the strain's.
    const double lost = dt * outflow * element_weight_[e];
    pressure_[e] -= modulus * lost * (1.0 + 0.5 * lost);
  }
}

template <int Dim>
VectorField<Dim> ExplicitNodal<Dim>::velocity_at(double ahead) const {
  if (velocity_spacing_ == 0.0) return velocity_;
  VectorField<Dim> result(velocity_.size());
  for (std::size_t i = 0; i < velocity_.size(); ++i) {
    result[i] = velocity_[i] + ahead / velocity_spacing_ * (velocity_[i] - previous_velocity_[i]);
  }
  return result;
}

template class ExplicitNodal<2>;

}  // namespace suffuse
