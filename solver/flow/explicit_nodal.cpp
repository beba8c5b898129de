#include "flow/explicit_nodal.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>

namespace suffuse {
namespace {

/// Below this many entities a loop is shorter than waking the threads.
constexpr int worth_threads_of_nodes = 8192;

/// Inner nodes are taken by the number of their neighbours within windows of so many: loops around
/// them then have lengths that the processor foresees, and windows stay in its fastest memory.
constexpr int window = 1024;

/// How far loops look ahead, for memory to have delivered by then.
constexpr int blocks_ahead = 12;

template <class Value>
double bytes(const std::vector<Value>& values) {
  return static_cast<double>(values.size() * sizeof(Value));
}

/// rho_w / rho_w0 - 1 at a pressure small against K; the exact value is restored with the masses.
template <class Real>
void density_excess(const Real& pressure_over_modulus, Real& excess) {
  const Real& x = pressure_over_modulus;
  excess = x * (1.0 + 0.5 * x * (1.0 + (1.0 / 3.0) * x));
}

/// Place and flux of a node: x, y, q_x, q_y. Of one node or of one in each lane.
template <class Real>
using Corner = std::array<Real, 4>;

/// Volume per second through the edge from `a` to `b`, to its right: its normal times the mean flux
/// of both. From `b` to `a` it is the same with the other sign, to the last bit.
template <class Real>
void edge_flux(const Corner<Real>& a, const Corner<Real>& b, Real& flux) {
  flux = 0.5 * ((b[1] - a[1]) * (a[2] + b[2]) - (b[0] - a[0]) * (a[3] + b[3]));
}

/// Velocity, or flux, after `spacing` seconds, from its rate without drag, m/s2.
template <class Real, std::size_t dim>
void drag_along(const std::array<Real, dim>& rate, const Real& damping, double spacing,
                bool implicit_drag, std::array<Real, dim>& v) {
  for (std::size_t d = 0; d < dim; ++d) {
    if (implicit_drag) {
      v[d] = (v[d] + spacing * rate[d]) / (1.0 + spacing * damping);
    } else {
      v[d] = v[d] + spacing * (rate[d] - damping * v[d]);
    }
  }
}

/// Pressure after a step that let out a share `lost` of the element's water. ln(1 - lost) to second
/// order: the density's own increment, not only the strain's.
template <class Real>
void expand(const Real& lost, double modulus, Real& pressure) {
  pressure = pressure - modulus * lost * (1.0 + 0.5 * lost);
}

}  // namespace

template <int Dim>
ExplicitNodal<Dim>::ExplicitNodal(const NodalOperator<Dim>& op, ExplicitSettings settings)
    : operator_(op),
      settings_(settings),
      pressure_(op.grid().mesh.element_count(), 0.0),
      next_pressure_(pressure_),
      flux_(op.grid().mesh.node_count(), Vector<Dim>::Zero()),
      velocity_(flux_),
      has_gravity_(!op.gravity().isZero(0.0)) {
  for (int f = 0; f < op.grid().face_count(); ++f) {
    const FaceKind kind = op.conditions()[f].kind;
    if (kind == FaceKind::velocity || kind == FaceKind::flux) driven_faces_.push_back(f);
  }
  make_node_blocks();
  make_element_blocks();
  reset_volumes();
}

template <int Dim>
void ExplicitNodal<Dim>::make_node_blocks() {
  const Grid<Dim>& grid = operator_.grid();
  const auto at_edge = [&](int i) {
    const auto faces = std::span(grid.node_face)
                           .subspan(grid.node_face_begin[i],
                                    grid.node_face_begin[i + 1] - grid.node_face_begin[i]);
    return faces.empty() || std::ranges::any_of(faces, [&](int f) {
             return grid.is_outer(f) || operator_.conditions()[f].kind != FaceKind::interior;
           });
  };
  std::vector<int> inner;
  std::vector<int> edge;
  for (int i = 0; i < grid.mesh.node_count(); ++i) (at_edge(i) ? edge : inner).push_back(i);
  for (; inner.size() % simd_width != 0; inner.pop_back()) edge.push_back(inner.back());
  std::ranges::sort(edge);
  for (const int i : edge) edge_nodes_.push_back({i, -1, 0.0, 0.0, 0.0, Vector<Dim>::Zero()});

  const auto neighbours = [&](int i) {
    return grid.node_element_begin[i + 1] - grid.node_element_begin[i];
  };
  for (auto first = inner.begin(); first != inner.end();) {
    const auto last = first + std::min<std::ptrdiff_t>(window, inner.end() - first);
    std::stable_sort(first, last, [&](int a, int b) { return neighbours(a) < neighbours(b); });
    first = last;
  }
  for (std::size_t k = 0; k < inner.size(); k += simd_width) {
    NodeBlock& block = node_blocks_.emplace_back();
    std::copy_n(&inner[k], simd_width, block.node.begin());
    block.first_step = static_cast<int>(ring_steps_.size());
    block.last_step = block.first_step + neighbours(block.node.back());
    ring_steps_.resize(block.last_step);
    for (int l = 0; l < simd_width; ++l) {
      const int i = block.node[l];
      int e = grid.node_element[grid.node_element_begin[i]];
      for (int step = 0; step < block.last_step - block.first_step; ++step) {
        RingStep& to = ring_steps_[block.first_step + step];
        if (step >= neighbours(i)) {
          to.node[l] = i;
          to.element[l] = (&to)[-1].element[l];
          continue;
        }
        const auto& corners = grid.mesh.elements[e];
        const auto at = static_cast<int>(std::ranges::find(corners, i) - corners.begin());
        const int next = (at + 1) % (Dim + 1);
        to.node[l] = corners[next];
        to.element[l] = e;
        e = grid.across(e, next);
      }
    }
  }
}

template <int Dim>
void ExplicitNodal<Dim>::make_element_blocks() {
  const Grid<Dim>& grid = operator_.grid();
  const int elements = grid.mesh.element_count();
  element_blocks_.resize(elements / simd_width);
  if (!settings_.pressure_moves_with_liquid) convection_blocks_.resize(element_blocks_.size());
  const int in_blocks = simd_width * static_cast<int>(element_blocks_.size());
  for (int e = 0; e < elements; ++e) {
    bool at_edge = e >= in_blocks;
    const int b = e / simd_width;
    const int l = e % simd_width;
    for (int k = 0; k <= Dim; ++k) {
      const int neighbour = grid.across(e, k);
      at_edge = at_edge || neighbour < 0 || operator_.flux_is_fixed(grid.element_face[e][k]);
      if (e >= in_blocks) continue;
      element_blocks_[b].node[k][l] = grid.mesh.elements[e][k];
      if (convection_blocks_.empty()) continue;
      convection_blocks_[b].neighbour[k][l] = neighbour < 0 ? e : neighbour;
    }
    if (at_edge) edge_elements_.push_back({e, 0.0, {}, {}});
  }
}

template <int Dim>
void ExplicitNodal<Dim>::update(const FlowCoefficients<Dim>& coefficients) {
  remember_velocity();
  porosity_ = operator_.carried_porosity();
  take_velocity();
  set_node_coefficients();
  set_element_coefficients(coefficients);
  reset_volumes();
}

template <int Dim>
void ExplicitNodal<Dim>::set_node_coefficients() {
  const std::vector<double>& quadratic = operator_.node_quadratic_drag();
  const auto per_mass = [&](int i) {
    return 1.0 / (settings_.mass_scaling * operator_.node_mass()[i]);
  };
  const auto mobility = [&](int i) { return porosity_[i] * per_mass(i); };
  const auto damping = [&](int i) { return per_mass(i) * operator_.node_drag()[i]; };
  const auto quadratic_damping = [&](int i) { return per_mass(i) * quadratic[i] / porosity_[i]; };

  quadratic_damping_.resize(quadratic.empty() ? 0 : node_blocks_.size());
  for (std::size_t b = 0; b < node_blocks_.size(); ++b) {
    NodeBlock& block = node_blocks_[b];
    for (int l = 0; l < simd_width; ++l) {
      block.mobility[l] = mobility(block.node[l]);
      block.damping[l] = damping(block.node[l]);
      if (!quadratic.empty()) quadratic_damping_[b][l] = quadratic_damping(block.node[l]);
    }
  }
  const auto& constraints = operator_.constraints();
  auto constraint = constraints.begin();
  for (BoundaryNode& edge : edge_nodes_) {
    const int i = edge.node;
    edge.mobility = mobility(i);
    edge.damping = damping(i);
    edge.quadratic_damping = quadratic.empty() ? 0.0 : quadratic_damping(i);
    while (constraint != constraints.end() && constraint->node < i) ++constraint;
    const bool found = constraint != constraints.end() && constraint->node == i;
    edge.constraint = found ? static_cast<int>(constraint - constraints.begin()) : -1;
  }
}

template <int Dim>
void ExplicitNodal<Dim>::set_element_coefficients(const FlowCoefficients<Dim>& coefficients) {
  const Grid<Dim>& grid = operator_.grid();
  const auto weight = [&](int e) {
    const double carried = settings_.porosity_gradient_term ? 1.0 : coefficients.porosity[e];
    return carried / coefficients.water_volume[e];
  };
  const auto carried = [&](int e, int k) {
    const double c = coefficients.face_concentration[grid.element_face[e][k]];
    return (1.0 - c) / settings_.bulk_modulus;
  };
  for (std::size_t b = 0; b < element_blocks_.size(); ++b) {
    for (int l = 0; l < simd_width; ++l) {
      const int e = simd_width * static_cast<int>(b) + l;
      element_blocks_[b].weight[l] = weight(e);
      if (convection_blocks_.empty()) continue;
      for (int k = 0; k <= Dim; ++k) convection_blocks_[b].carried[k][l] = carried(e, k);
    }
  }
  for (BoundaryElement& edge : edge_elements_) {
    edge.weight = weight(edge.element);
    for (int k = 0; k <= Dim; ++k) edge.carried[k] = carried(edge.element, k);
  }
}

template <int Dim>
void ExplicitNodal<Dim>::take_velocity() {
  velocity_is_current_ = true;
  for (std::size_t i = 0; i < porosity_.size(); ++i) flux_[i] = porosity_[i] * velocity_[i];
}

template <int Dim>
const VectorField<Dim>& ExplicitNodal<Dim>::velocity() const {
  if (velocity_is_current_) return velocity_;
  velocity_.resize(flux_.size());
  for (std::size_t i = 0; i < flux_.size(); ++i) velocity_[i] = flux_[i] / porosity_[i];
  velocity_is_current_ = true;
  return velocity_;
}

template <int Dim>
void ExplicitNodal<Dim>::archive(StateArchive& archive) {
  remember_velocity();
  archive(pressure_, flux_, velocity_, last_dt_, velocity_spacing_);
}

template <int Dim>
const VectorField<Dim>& ExplicitNodal<Dim>::previous_velocity() const {
  if (previous_velocity_.empty()) {
    throw std::logic_error("the velocity before the last step was not remembered");
  }
  return previous_velocity_;
}

template <int Dim>
void ExplicitNodal<Dim>::step(double dt) {
  velocity_spacing_ = 0.5 * (last_dt_ + dt);
  accelerate(velocity_spacing_, dt);
  compress(dt);
  last_dt_ = dt;
}

template <int Dim>
void ExplicitNodal<Dim>::accelerate(double spacing, double dt) {
  if (velocity_is_current_) {
    std::swap(velocity_, previous_velocity_);
  } else {
    previous_velocity_.clear();
  }
  velocity_is_current_ = false;
  const int blocks = static_cast<int>(node_blocks_.size());
  const int edge_nodes = static_cast<int>(edge_nodes_.size());
#pragma omp parallel num_threads(settings_.threads) if (simd_width * blocks > \
                                                        worth_threads_of_nodes)
  {
#pragma omp for schedule(static) nowait
    for (int b = 0; b < blocks; ++b) accelerate_block(spacing, dt, b);
#pragma omp for schedule(static)
    for (int k = 0; k < edge_nodes; ++k) accelerate_edge(spacing, dt, edge_nodes_[k]);
  }
}

/// dq_i/dt = n_i / (S m_i) force + n_i g / S - damping q_i of a few inner nodes: momentum times the
/// porosity of the node, which does not change meanwhile.
template <int Dim>
void ExplicitNodal<Dim>::accelerate_block(double spacing, double dt, int b) {
  const NodeBlock& block = node_blocks_[b];
  const auto& node = block.node;
  const int last = static_cast<int>(node_blocks_.size()) - 1;
  const int soon = std::min(b + blocks_ahead, last);
  prefetch(node_blocks_[std::min(soon + blocks_ahead, last)]);
  prefetch(way_[soon]);
  for (int s = node_blocks_[soon].first_step; s < node_blocks_[soon].last_step; ++s) {
    prefetch(ring_steps_[s]);
  }
  const Vector<Dim>* const place = operator_.grid().mesh.nodes.data();
  const double* const pressure = pressure_.data();

  // Each face at the node pushes with the difference of the pressures on its sides, on half its
  // normal: the transpose of the flux.
  SimdDouble4 x;
  SimdDouble4 y;
  load_pairs([&](int l) { return place[node[l]].data(); }, x, y);
  SimdDouble4 push_x{};
  SimdDouble4 push_y{};
  SimdDouble4 before;
  gather(pressure, ring_steps_[block.last_step - 1].element, before);
  for (int s = block.first_step; s < block.last_step; ++s) {
    const RingStep& step = ring_steps_[s];
    SimdDouble4 to_x;
    SimdDouble4 to_y;
    load_pairs([&](int l) { return place[step.node[l]].data(); }, to_x, to_y);
    SimdDouble4 after;
    gather(pressure, step.element, after);
    push_x -= (to_y - y) * (before - after);
    push_y += (to_x - x) * (before - after);
    before = after;
  }

  Vector<Dim>* const flux = flux_.data();
  std::array<SimdDouble4, Dim> q;
  load_pairs([&](int l) { return flux[node[l]].data(); }, q[0], q[1]);
  SimdDouble4 damping = block.damping;
  if (!quadratic_damping_.empty()) {
    SimdDouble4 speed;
    square_root(q[0] * q[0] + q[1] * q[1], speed);
    damping += quadratic_damping_[b] * speed;
  }
  std::array<SimdDouble4, Dim> rate{0.5 * block.mobility * push_x, 0.5 * block.mobility * push_y};
  if (has_gravity_) {
    SimdDouble4 porosity;
    gather(porosity_.data(), node, porosity);
    for (int d = 0; d < Dim; ++d) {
      rate[d] += porosity * (operator_.gravity()[d] / settings_.mass_scaling);
    }
  }
  drag_along(rate, damping, spacing, settings_.drag == DragIntegration::implicit_drag, q);
  for (int d = 0; d < Dim; ++d) way_[b][d] += dt * q[d];
  store_pairs(q[0], q[1], [&](int l) { return flux[node[l]].data(); });
}

template <int Dim>
void ExplicitNodal<Dim>::accelerate_edge(double spacing, double dt, BoundaryNode& edge) {
  const int i = edge.node;
  const Vector<Dim> rate = edge.mobility * operator_.force(i, pressure_);
  const double damping = edge.damping + edge.quadratic_damping * flux_[i].norm();
  std::array<double, Dim> q{flux_[i][0], flux_[i][1]};
  drag_along({rate[0], rate[1]}, damping, spacing, settings_.drag == DragIntegration::implicit_drag,
             q);
  flux_[i] = {q[0], q[1]};
  if (edge.constraint >= 0) {
    const NodeConstraint<Dim>& held = operator_.constraints()[edge.constraint];
    flux_[i] = (held.free * flux_[i] + porosity_[i] * held.prescribed).eval();
  }
  edge.way += dt * flux_[i];
}

template <int Dim>
void ExplicitNodal<Dim>::compress(double dt) {
  if (settings_.pressure_moves_with_liquid) {
    compress_blocks<false>(dt);
  } else {
    compress_blocks<true>(dt);
  }
  for (std::size_t b = 0; b < driven_faces_.size(); ++b) {
    driven_volume_[b] += dt * operator_.fixed_flux(driven_faces_[b]);
  }
  std::swap(pressure_, next_pressure_);
}

template <int Dim>
template <bool convects>
void ExplicitNodal<Dim>::compress_blocks(double dt) {
  const int blocks = static_cast<int>(element_blocks_.size());
  const int edge_elements = static_cast<int>(edge_elements_.size());
#pragma omp parallel num_threads(settings_.threads) if (simd_width * blocks > \
                                                        worth_threads_of_nodes)
  {
#pragma omp for schedule(static)
    for (int b = 0; b < blocks; ++b) compress_block<convects>(dt, b);
#pragma omp for schedule(static)
    for (int k = 0; k < edge_elements; ++k) compress_edge(dt, edge_elements_[k]);
  }
}

/// Pressure of a few elements from the liquid that leaves them. What enters brings the pressure of
/// where it comes from; what leaves has their own.
template <int Dim>
template <bool convects>
void ExplicitNodal<Dim>::compress_block(double dt, int b) {
  const double modulus = settings_.bulk_modulus;
  const double* const pressure = pressure_.data();
  const Vector<Dim>* const place = operator_.grid().mesh.nodes.data();
  const Vector<Dim>* const node_flux = flux_.data();
  const ElementBlock& block = element_blocks_[b];
  const std::ptrdiff_t first = std::ptrdiff_t{simd_width} * b;
  const int soon = std::min(b + blocks_ahead, static_cast<int>(element_blocks_.size()) - 1);
  prefetch(element_blocks_[soon]);
  prefetch(next_pressure_[std::size_t{simd_width} * soon]);
  OfFaces<Corner<SimdDouble4>> corner;
  for (int a = 0; a <= Dim; ++a) {
    load_pairs([&](int l) { return place[block.node[a][l]].data(); }, corner[a][0], corner[a][1]);
    load_pairs([&](int l) { return node_flux[block.node[a][l]].data(); }, corner[a][2],
               corner[a][3]);
  }
  OfFaces<SimdDouble4> flux;
  for (int k = 0; k <= Dim; ++k) {
    edge_flux(corner[(k + 1) % (Dim + 1)], corner[(k + 2) % (Dim + 1)], flux[k]);
  }
  SimdDouble4 outflow = flux[0] + flux[1] + flux[2];
  SimdDouble4 p;
  load(pressure + first, p);
  if constexpr (convects) {
    const ConvectionBlock& convection = convection_blocks_[b];
    prefetch(convection_blocks_[soon]);
    prefetch(excess_out_[soon]);
    const SimdDouble4 zero{};
    SimdDouble4 excess;
    density_excess<SimdDouble4>(p * (1.0 / modulus), excess);
    excess *= dt;
    for (int k = 0; k <= Dim; ++k) {
      SimdDouble4 across;
      gather(pressure, convection.neighbour[k], across);
      const SimdDouble4 inflow = flux[k] < zero ? flux[k] : zero;
      outflow += inflow * convection.carried[k] * (across - p);
      excess_out_[b][k] += excess * (flux[k] - inflow);
    }
  }
  expand<SimdDouble4>(dt * outflow * block.weight, modulus, p);
  store(p, next_pressure_.data() + first);
}

template <int Dim>
double ExplicitNodal<Dim>::face_flux(int element, int k) const {
  const Grid<Dim>& grid = operator_.grid();
  const int f = grid.element_face[element][k];
  if (operator_.flux_is_fixed(f)) {
    return grid.element_face_sign[element][k] * operator_.fixed_flux(f);
  }
  const auto corner = [&](int a) {
    const int i = grid.mesh.elements[element][a % (Dim + 1)];
    const Vector<Dim>& place = grid.mesh.nodes[i];
    return Corner<double>{place[0], place[1], flux_[i][0], flux_[i][1]};
  };
  double flux = 0.0;
  edge_flux(corner(k + 1), corner(k + 2), flux);
  return flux;
}

/// Writes over what the block made of this element, as if all of its faces were inner ones.
template <int Dim>
void ExplicitNodal<Dim>::compress_edge(double dt, BoundaryElement& edge) {
  const Grid<Dim>& grid = operator_.grid();
  const double modulus = settings_.bulk_modulus;
  const int e = edge.element;
  double p = pressure_[e];
  double outflow = 0.0;
  for (int k = 0; k <= Dim; ++k) {
    const double flux = face_flux(e, k);
    outflow += flux;
    if (settings_.pressure_moves_with_liquid) continue;
    const int neighbour = grid.across(e, k);
    const FaceCondition& condition = operator_.conditions()[grid.element_face[e][k]];
    double upwind = p;
    if (flux < 0.0) {
      if (neighbour >= 0) {
        upwind = pressure_[neighbour];
      } else if (condition.kind == FaceKind::pressure) {
        upwind = condition.value;
      }
    }
    outflow += flux * edge.carried[k] * (upwind - p);
    // What enters from another element that one has let out.
    if (flux > 0.0 || neighbour < 0) {
      double excess = 0.0;
      density_excess(upwind / modulus, excess);
      edge.excess_out[k] += dt * flux * excess;
    }
  }
  expand(dt * outflow * edge.weight, modulus, p);
  next_pressure_[e] = p;
}

template <int Dim>
void ExplicitNodal<Dim>::reset_volumes() {
  way_.assign(node_blocks_.size(), {});
  for (BoundaryNode& edge : edge_nodes_) edge.way.setZero();
  excess_out_.assign(convection_blocks_.size(), {});
  for (BoundaryElement& edge : edge_elements_) edge.excess_out = {};
  driven_volume_.assign(driven_faces_.size(), 0.0);
}

template <int Dim>
VectorField<Dim> ExplicitNodal<Dim>::ways() const {
  VectorField<Dim> result(flux_.size());
  for (std::size_t b = 0; b < node_blocks_.size(); ++b) {
    for (int l = 0; l < simd_width; ++l) {
      for (int d = 0; d < Dim; ++d) result[node_blocks_[b].node[l]][d] = way_[b][d][l];
    }
  }
  for (const BoundaryNode& edge : edge_nodes_) result[edge.node] = edge.way;
  return result;
}

template <int Dim>
VectorField<Dim> ExplicitNodal<Dim>::displacements() const {
  if (!settings_.sum_displacements) return {};
  VectorField<Dim> result = ways();
  for (std::size_t i = 0; i < porosity_.size(); ++i) result[i] /= porosity_[i];
  return result;
}

template <int Dim>
FaceVolumes ExplicitNodal<Dim>::volumes() const {
  const Grid<Dim>& grid = operator_.grid();
  const int faces = grid.face_count();
  FaceVolumes result;
  result.liquid.assign(faces, 0.0);
  const VectorField<Dim> way = ways();
#pragma omp parallel for schedule(static) \
    num_threads(settings_.threads) if (faces > worth_threads_of_nodes)
  for (int f = 0; f < faces; ++f) {
    if (operator_.flux_is_fixed(f)) continue;
    const auto [a, b] = grid.face_nodes[f];
    result.liquid[f] = 0.5 * grid.face_normal[f].dot(way[a] + way[b]);
  }
  for (std::size_t b = 0; b < driven_faces_.size(); ++b) {
    result.liquid[driven_faces_[b]] = driven_volume_[b];
  }
  if (settings_.pressure_moves_with_liquid) return result;

  // What each element let out; blocks hold nothing of worth for those at the edge.
  result.density_excess.assign(faces, 0.0);
  const auto add = [&](int e, int k, double excess) {
    result.density_excess[grid.element_face[e][k]] += grid.element_face_sign[e][k] * excess;
  };
  auto edge = edge_elements_.begin();
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    const bool at_edge = edge != edge_elements_.end() && edge->element == e;
    for (int k = 0; k <= Dim; ++k) {
      add(e, k, at_edge ? edge->excess_out[k] : excess_out_[e / simd_width][k][e % simd_width]);
    }
    if (at_edge) ++edge;
  }
  return result;
}

template <int Dim>
VectorField<Dim> ExplicitNodal<Dim>::velocity_at(double ahead) const {
  VectorField<Dim> result = velocity();
  if (velocity_spacing_ == 0.0) return result;
  const VectorField<Dim>& previous = previous_velocity();
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] += ahead / velocity_spacing_ * (result[i] - previous[i]);
  }
  return result;
}

template <int Dim>
double ExplicitNodal<Dim>::bytes_accelerating() const {
  return bytes(node_blocks_) + bytes(ring_steps_) + bytes(pressure_) +
         bytes(operator_.grid().mesh.nodes) + 2.0 * (bytes(flux_) + bytes(way_));
}

template <int Dim>
double ExplicitNodal<Dim>::bytes_compressing() const {
  return bytes(element_blocks_) + bytes(convection_blocks_) + bytes(operator_.grid().mesh.nodes) +
         bytes(flux_) + bytes(pressure_) + bytes(next_pressure_) + 2.0 * bytes(excess_out_);
}

template class ExplicitNodal<2>;

}  // namespace suffuse
