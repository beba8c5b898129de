#include "explicit/explicit_nodal.hpp"

#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// A loop over fewer indices is shorter than waking the threads.
constexpr int worth_threads_of_flow = 8192;

/// rho_w / rho_w0 - 1 = exp(p / K) - 1 to third order, for p small against K; the exact value is
/// restored with the masses.
double density_excess(double pressure_over_modulus) {
  const double x = pressure_over_modulus;
  return x * (1.0 + 0.5 * x * (1.0 + (1.0 / 3.0) * x));
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
      convected_flux_(settings.pressure_moves_with_liquid ? 0 : op.grid().face_count(), 0.0) {
  reset_volumes();
}

template <int Dim>
void ExplicitNodal<Dim>::update(const FlowCoefficients<Dim>& coefficients) {
  inverse_mass_.clear();
  for (const double mass : operator_.node_mass()) {
    inverse_mass_.push_back(1.0 / (settings_.mass_scaling * mass));
  }
  compression_.clear();
  for (std::size_t e = 0; e < pressure_.size(); ++e) {
    const double carried = settings_.porosity_gradient_term ? 1.0 : coefficients.porosity[e];
    compression_.push_back(carried / coefficients.water_volume[e]);
  }
  convection_.clear();
  for (const double c : coefficients.face_concentration) {
    convection_.push_back((1.0 - c) / settings_.bulk_modulus);
  }
  reset_volumes();
}

template <int Dim>
void ExplicitNodal<Dim>::archive(StateArchive& archive) {
  archive(on_elements(pressure_), on_nodes(velocity_), last_dt_);
}

template <int Dim>
void ExplicitNodal<Dim>::step(double dt) {
  accelerate(0.5 * (last_dt_ + dt));
  cross_faces(dt);
  compress(dt);
  last_dt_ = dt;
}

template <int Dim>
void ExplicitNodal<Dim>::exchange() {
  const Grid<Dim>& grid = operator_.grid();
  grid.node_rows().exchange(velocity_);
  grid.face_rows().exchange(volumes_.liquid);
  if (!settings_.pressure_moves_with_liquid) grid.face_rows().exchange(volumes_.density_excess);
}

/// S m_i dv_i/dt = force_i - drag_i v_i. Reads pressures, writes velocities.
template <int Dim>
void ExplicitNodal<Dim>::accelerate(double spacing) {
  const std::vector<double>& drag = operator_.node_drag();
  const std::vector<double>& quadratic_drag = operator_.node_quadratic_drag();
  const bool implicit_drag = settings_.drag == DragIntegration::implicit_drag;
  std::swap(velocity_, previous_velocity_);
  for_each_index(
      static_cast<int>(velocity_.size()), settings_.threads,
      [&](int i) {
        const Vector<Dim>& before = previous_velocity_[i];
        const double rate = spacing * inverse_mass_[i];
        double damping = rate * drag[i];
        if (!quadratic_drag.empty()) damping += rate * quadratic_drag[i] * before.norm();
        const Vector<Dim> gain = rate * operator_.force(i, pressure_);
        velocity_[i] = implicit_drag ? Vector<Dim>((before + gain) / (1.0 + damping))
                                     : Vector<Dim>(before + gain - damping * before);
      },
      worth_threads_of_flow);
  operator_.constrain(velocity_);
}

/// Pressure beyond an outer face, which entering liquid has.
template <int Dim>
double ExplicitNodal<Dim>::outer_pressure(int face) const {
  const FaceCondition& condition = operator_.conditions()[face];
  return condition.kind == FaceKind::pressure ? condition.value
                                              : pressure_[operator_.grid().face_left[face]];
}

/// Reads velocities and pressures, writes fluxes and adds up volumes.
template <int Dim>
void ExplicitNodal<Dim>::cross_faces(double dt) {
  const Grid<Dim>& grid = operator_.grid();
  const double compressibility = 1.0 / settings_.bulk_modulus;
  for_each_index(
      grid.face_count(), settings_.threads,
      [&](int f) {
        const double flux = operator_.face_flux(f, velocity_);
        volumes_.liquid[f] += dt * flux;
        face_flux_[f] = flux;
        if (settings_.pressure_moves_with_liquid) return;
        const double left = pressure_[grid.face_left[f]];
        const double right = grid.is_outer(f) ? outer_pressure(f) : pressure_[grid.face_right[f]];
        const double upwind = flux < 0.0 ? right : left;
        volumes_.density_excess[f] += dt * flux * density_excess(upwind * compressibility);
        convected_flux_[f] = flux * convection_[f];
        face_flux_[f] += convected_flux_[f] * upwind;
      },
      worth_threads_of_flow);
}

/// dp_e/dt = -K outflow / water volume. Reads fluxes, writes pressures.
template <int Dim>
void ExplicitNodal<Dim>::compress(double dt) {
  const Grid<Dim>& grid = operator_.grid();
  const bool convects = !settings_.pressure_moves_with_liquid;
  for_each_index(
      static_cast<int>(pressure_.size()), settings_.threads,
      [&](int e) {
        const double p = pressure_[e];
        double outflow = 0.0;
        for (int k = 0; k <= Dim; ++k) {
          const int f = grid.element_face[e][k];
          const double flux = convects ? face_flux_[f] - convected_flux_[f] * p : face_flux_[f];
          outflow += grid.face_left[f] == e ? flux : -flux;
        }
        // ln(1 - lost) to second order: the density's own increment, not only the strain's.
        const double lost = dt * outflow * compression_[e];
        pressure_[e] = p - settings_.bulk_modulus * lost * (1.0 + 0.5 * lost);
      },
      worth_threads_of_flow);
  grid.element_rows().exchange(pressure_);
}

template <int Dim>
void ExplicitNodal<Dim>::reset_volumes() {
  const int faces = operator_.grid().face_count();
  volumes_.liquid.assign(faces, 0.0);
  if (!settings_.pressure_moves_with_liquid) volumes_.density_excess.assign(faces, 0.0);
}

template class ExplicitNodal<2>;

}  // namespace suffuse
