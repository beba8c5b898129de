#include "points/fines_deposition.hpp"

#include <cmath>
#include <limits>

namespace suffuse {

template <int Dim>
FinesDeposition<Dim>::FinesDeposition(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                                      const SharedPoints<Dim>& shared, double grain_density)
    : grid_(grid),
      solid_(solid),
      shared_(shared),
      grain_density_(grain_density),
      active_(solid.soils().deposits()) {}

template <int Dim>
void FinesDeposition<Dim>::start(double duration) {
  duration_ = duration;
  deposited_.clear();
  by_region_.assign(grid_.mesh.region_names.size(), {});
  lost_by_region_ = by_region_;
  const SoilMap<Dim>& soils = solid_.soils();
  room_.assign(grid_.mesh.element_count(), 1.0);
  capacity_.assign(grid_.mesh.element_count(), std::numeric_limits<double>::infinity());
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    const DepositionModel& deposition = soils.exchange_of_element(e).deposition;
    const bool is_left = soils.points_begin(e) == soils.points_begin(e + 1);  // by moving soil
    if (is_left) room_[e] = 0.0;
    if (is_left || !deposition.deposits() || !deposition.has_room_limit()) continue;
    double room = 0.0;
    double volume = 0.0;
    capacity_[e] = 0.0;
    for (int p = soils.points_begin(e); p < soils.points_begin(e + 1); ++p) {
      const double own = soils.points().volume[p];
      const double porosity = solid_.porosity()[p];
      volume += own;
      if (!deposition.has_room_at(porosity)) continue;  // compressed below n_min
      room += own * deposition.room(solid_.initial_porosity()[p], porosity);
      capacity_[e] += own * (porosity - deposition.porosity_min);
    }
    room_[e] = room / volume;
  }
}

template <int Dim>
double FinesDeposition<Dim>::catching(int element, double flux) const {
  const DepositionModel& deposition = solid_.soils().exchange_of_element(element).deposition;
  const bool catches = deposition.deposits() && flux < deposition.flux_max;
  return catches ? deposition.coefficient * room_[element] : 0.0;
}

template <int Dim>
double FinesDeposition<Dim>::exponent(const FacePassage<Dim>& passage) const {
  if (!(passage.path > 0.0)) return 0.0;
  const double flux = passage.path / (passage.clock * duration_);
  return catching(passage.element, flux) * passage.path;
}

template <int Dim>
std::vector<double> FinesDeposition<Dim>::room_shares(const std::vector<double>& demand) const {
  // Room decays as exp(-a), a being the demand over the capacity.
  std::vector<double> shares(demand.size(), 1.0);
  for (std::size_t e = 0; e < demand.size(); ++e) {
    const double a = demand[e] / capacity_[e];
    if (a > 0.0) shares[e] = -std::expm1(-a) / a;
  }
  return shares;
}

template <int Dim>
void FinesDeposition<Dim>::leave_along_paths(const std::vector<double>& fines_before,
                                             std::vector<FinesUptake<Dim>>& uptakes,
                                             LiquidPoints<Dim>& points) {
  const auto sum_in_elements = [&](const auto& volume_of) {
    const auto sums = shared_.template sums<1>([&](const auto& add) {
      for (FinesUptake<Dim>& uptake : uptakes) {
        add(uptake.element, uptake.point, {volume_of(uptake)});
      }
    });
    std::vector<double> result;
    result.reserve(sums.size());
    for (const auto& [volume] : sums) result.push_back(volume);
    return result;
  };
  const std::vector<double> shares =
      room_shares(sum_in_elements([&](const FinesUptake<Dim>& uptake) {
        return uptake.exponent * points.fines_mass[uptake.point] / grain_density_;
      }));
  int point = -1;
  double fines = 0.0;
  hand_out(sum_in_elements([&](FinesUptake<Dim>& uptake) {
    if (uptake.point != point) {
      point = uptake.point;
      fines = fines_before[point];
    }
    // Half of the deposition precedes the uptake there, half follows: second order.
    const double left = std::exp(-0.5 * uptake.exponent * shares[uptake.element]);
    const double after = (fines * left + uptake.mass) * left;
    const double mass = fines + uptake.mass - after;
    uptake.mass -= mass;
    fines = after;
    points.fines_mass[point] -= mass;
    lost_by_region_[uptake.region].add(mass);
    return mass / grain_density_;
  }));
}

template <int Dim>
void FinesDeposition<Dim>::leave_in_elements(const std::vector<Vector<Dim>>& passed,
                                             const std::vector<double>& porosity,
                                             PointBlocks<Dim>& points) {
  const int elements = grid_.mesh.element_count();
  std::vector<double> exponent(elements);
  std::vector<double> demand(elements, 0.0);
  for (int e = 0; e < elements; ++e) {
    const double volume = passed[e].norm();
    exponent[e] = catching(e, volume / duration_) * volume / porosity[e];
    for (int k = 0; k < points.count(e); ++k) {
      demand[e] += exponent[e] * points.fines_mass(e, k) / grain_density_;
    }
  }
  const std::vector<double> shares = room_shares(demand);
  std::vector<double> caught(elements, 0.0);
  for (int e = 0; e < elements; ++e) {
    if (exponent[e] == 0.0) continue;
    const double share = -std::expm1(-exponent[e] * shares[e]);
    for (int k = 0; k < points.count(e); ++k) {
      const double mass = share * points.fines_mass(e, k);
      points.add_fines(e, k, -mass);
      caught[e] += mass / grain_density_;
      lost_by_region_[grid_.mesh.element_region[e]].add(mass);
    }
  }
  hand_out(caught);
}

template <int Dim>
void FinesDeposition<Dim>::hand_out(const std::vector<double>& caught) {
  const SoilMap<Dim>& soils = solid_.soils();
  deposited_.assign(soils.points().size(), 0.0);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    if (caught[e] == 0.0) continue;
    if (grid_.element_rows().owns(e)) {
      by_region_[grid_.mesh.element_region[e]].add(grain_density_ * caught[e]);
    }
    const DepositionModel& deposition = soils.exchange_of_element(e).deposition;
    const auto weight = [&](int p) {
      if (!deposition.has_room_at(solid_.porosity()[p])) return 0.0;
      const double room =
          deposition.has_room_limit() ? solid_.porosity()[p] - deposition.porosity_min : 1.0;
      return soils.points().volume[p] * room;
    };
    double all = 0.0;
    for (int p = soils.points_begin(e); p < soils.points_begin(e + 1); ++p) all += weight(p);
    for (int p = soils.points_begin(e); p < soils.points_begin(e + 1); ++p) {
      deposited_[p] = caught[e] * weight(p) / all;
    }
  }
}

template class FinesDeposition<2>;
template class FinesDeposition<3>;

}  // namespace suffuse
