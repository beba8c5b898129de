#include "points/point_injection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <sstream>
#include <tuple>

#include "common/errors.hpp"
#include "mesh/place_text.hpp"
#include "physics/liquid.hpp"
#include "points/face_placement.hpp"

namespace suffuse {
namespace {

/// Most points injected at one face in one step. More mean that the flow is wrong.
constexpr double max_injected = 1e7;

double fraction(double x) {
  return x - std::floor(x);
}

/// Uniform number in [0, 1) from integers alone (splitmix64): the same on every platform, and
/// independent of the order of injection.
double hashed(std::uint64_t seed, std::uint64_t face, std::uint64_t number, std::uint64_t use) {
  std::uint64_t x = seed;
  for (const std::uint64_t word : {face, number, use}) {
    x += 0x9e3779b97f4a7c15U + word;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    x ^= x >> 31U;
  }
  return static_cast<double>(x >> 11U) * 0x1.0p-53;
}

}  // namespace

template <int Dim>
InjectionSettings injection_settings(const Case<Dim>& c, const Grid<Dim>& grid) {
  const MaterialPoints<Dim>& points = c.liquid_points;
  std::vector<double> volume(grid.mesh.element_count(), 0.0);
  std::vector<int> count(grid.mesh.element_count(), 0);
  for (int p = 0; p < points.size(); ++p) {
    volume[points.element[p]] += points.volume[p];
    ++count[points.element[p]];
  }
  InjectionSettings result;
  result.random = c.document.scene.points.seeding == Seeding::random;
  result.seed = c.document.scene.points.seed;
  // Points of equal volume leave out elements that hold less than one.
  const double mean = std::accumulate(volume.begin(), volume.end(), 0.0) / points.size();
  for (const int e : grid.face_left) {
    result.point_volume.push_back(count[e] > 0 ? volume[e] / count[e] : mean);
    result.points_per_element.push_back(std::max(count[e], 1));
  }
  return result;
}

template <int Dim>
PointInjection<Dim>::PointInjection(const Grid<Dim>& grid,
                                    const std::vector<FaceCondition>& conditions,
                                    InjectionSettings settings, LiquidDensities densities,
                                    double bulk_modulus)
    : grid_(grid),
      conditions_(conditions),
      settings_(std::move(settings)),
      densities_(densities),
      bulk_modulus_(bulk_modulus) {
  for (const FaceCondition& condition : conditions) {
    const bool opens = condition.kind != FaceKind::interior && condition.kind != FaceKind::wall;
    is_open_.push_back(opens || condition.switches);
    const int face = static_cast<int>(is_open_.size()) - 1;
    if (is_open_.back() != 0 && grid.owns_face(face)) open_faces_.push_back(face);
  }
}

template <int Dim>
InflowAccount PointInjection<Dim>::initial_account(long next_id) const {
  InflowAccount account;
  account.next_id = next_id;
  account.injected.assign(grid_.face_count(), 0);
  account.volume.assign(grid_.face_count(), 0.0);
  for (const int f : open_faces_) {
    account.volume[f] = settings_.point_volume[f] *
                        fraction(0.5 + golden * static_cast<double>(grid_.face_number(f)));
  }
  return account;
}

template <int Dim>
PointPlace<Dim> PointInjection<Dim>::place_on_face(int face, long number,
                                                   const VectorField<Dim>& node_flux) const {
  // Finds a place distributed like the inflow of the face.
  const auto& nodes = grid_.face_nodes[face];
  std::array<double, Dim> inflow;
  inflow.fill(1.0);  // without `node_flux`: constant over the face
  for (int a = 0; a < Dim && !node_flux.empty(); ++a) {
    inflow[a] = std::max(0.0, -grid_.face_normal[face].dot(node_flux[nodes[a]]));
  }
  const long in_whole = grid_.face_number(face);
  std::array<double, Dim - 1> u = even_numbers<Dim - 1>(number, in_whole);
  for (int d = 0; d < Dim - 1 && settings_.random; ++d) {
    u[d] = hashed(settings_.seed, in_whole, number, d + 1);
  }
  const std::array<double, Dim> on_face = spread_on_face(inflow, u);
  const int e = grid_.face_left[face];
  PointPlace<Dim> place{e, {}};
  for (int a = 0; a <= Dim; ++a) {
    const auto found = std::find(nodes.begin(), nodes.end(), grid_.mesh.elements[e][a]);
    if (found != nodes.end()) place.barycentric[a] = on_face[found - nodes.begin()];
  }
  return place;
}

template <int Dim>
double PointInjection<Dim>::volumes_at_injection(int face, long number) const {
  if (!settings_.random) return static_cast<double>(number) + 1.0;
  const long batch = settings_.points_per_element[face];
  const long first = number / batch * batch;
  // Kept, because an allocation at every open face in every step would be slow.
  thread_local std::vector<double> at;
  at.resize(batch);
  for (long k = 0; k < batch; ++k) {
    at[k] =
        static_cast<double>(batch) * hashed(settings_.seed, grid_.face_number(face), first + k, 0);
  }
  std::nth_element(at.begin(), at.begin() + (number - first), at.end());
  return static_cast<double>(first) + at[number - first];
}

template <int Dim>
void PointInjection<Dim>::inject(InflowAccount& account, const std::vector<double>& volume,
                                 const VectorField<Dim>& node_flux,
                                 std::vector<InjectedPoint<Dim>>& points) const {
  for (const int f : open_faces_) {
    const double inflow = -volume[f];
    const double before = account.volume[f];
    account.volume[f] += inflow;
    if (inflow <= 0.0) continue;
    const double point_volume = settings_.point_volume[f];
    if (!(inflow <= max_injected * point_volume)) {
      std::ostringstream message;
      message << inflow << " m3 enter in one step at " << place_text<Dim>(grid_.face_centre(f))
              << ", more than " << max_injected
              << " liquid points hold; look at the boundary conditions and at gravity";
      throw NumericalError(message.str());
    }
    const long injected_before = account.injected[f];
    for (;;) {
      const long number = account.injected[f];
      // Inflow at which the point is due, in point volumes, minus the points injected before.
      const double due = volumes_at_injection(f, number) - static_cast<double>(injected_before);
      const double share = (due * point_volume - before) / inflow;
      if (share > 1.0) break;
      points.push_back({place_on_face(f, number, node_flux), f, number, std::max(0.0, share)});
      account.volume[f] -= point_volume;
      ++account.injected[f];
    }
  }
  std::ranges::sort(points, {}, [](const InjectedPoint<Dim>& point) {
    return std::tuple(point.share, point.face, point.number);
  });
}

template <int Dim>
auto PointInjection<Dim>::places(const std::vector<InjectedPoint<Dim>>& points) const -> Places {
  struct Key {
    double share;
    long face;
    long number;
    auto operator<=>(const Key&) const = default;  // NOLINT: of generated code
  };
  std::vector<Key> own;
  own.reserve(points.size());
  for (const InjectedPoint<Dim>& point : points) {
    own.push_back({point.share, grid_.face_number(point.face), point.number});
  }
  std::vector<Key> all = values_on_all(grid_.ranks(), own);
  std::ranges::sort(all);
  Places result{{}, static_cast<long>(all.size())};
  for (const Key& key : own) {
    result.of_point.push_back(std::ranges::lower_bound(all, key) - all.begin());
  }
  return result;
}

template <int Dim>
auto PointInjection<Dim>::content(const InjectedPoint<Dim>& point, double element_pressure) const
    -> Content {
  const double concentration = conditions_[point.face].concentration;
  const double volume = settings_.point_volume[point.face];
  const double ratio = density_ratio(element_pressure, bulk_modulus_);
  return {(1.0 - concentration) * volume * densities_.water * ratio,
          concentration * volume * densities_.grain};
}

template InjectionSettings injection_settings(const Case<2>&, const Grid<2>&);
template InjectionSettings injection_settings(const Case<3>&, const Grid<3>&);
template class PointInjection<2>;
template class PointInjection<3>;

}  // namespace suffuse
