#include "formulation/masses.hpp"

#include <cmath>

namespace suffuse {
namespace {

void book_one(double outward, ExactSum& in, ExactSum& out) {
  if (outward > 0.0) out.add(outward);
  if (outward < 0.0) in.add(-outward);
}

/// Row of the ledger, from present storage, crossings and initial storage.
LedgerRow ledger_row(double time, const Stored& stored, const Crossed& crossed,
                     const Stored& initial) {
  LedgerRow row;
  row.t = time;
  row.solid = stored.solid;
  row.erodible = stored.erodible;
  row.water = stored.water;
  row.fines = stored.fines;
  row.eroded = stored.eroded - initial.eroded;
  row.deposited = stored.deposited - initial.deposited;
  row.water_in = crossed.water_in;
  row.fines_in = crossed.fines_in;
  row.water_out = crossed.water_out;
  row.fines_out = crossed.fines_out;
  row.pending = stored.pending;
  row.carried = stored.carried;
  row.points = stored.points;
  row.points_in = crossed.points_in;
  row.points_out = crossed.points_out;
  row.residual_water = relative_residual((stored.water - initial.water) + crossed.water_net,
                                         initial.water, crossed.water_in, 0.0);
  row.residual_grains = relative_residual(
      (stored.solid - initial.solid) + (stored.fines - initial.fines) +
          (stored.pending - initial.pending) - stored.carried + crossed.fines_net,
      initial.solid + initial.fines + initial.pending, crossed.fines_in, stored.carried);
  return row;
}

}  // namespace

std::vector<Stored> totals(const Ranks& ranks, std::vector<StoredSums> sums) {
  StoredSums& model = sums.front();
  for (auto region = sums.begin() + 1; region != sums.end(); ++region) {
    model.solid.add(region->solid);
    model.erodible.add(region->erodible);
    model.water.add(region->water);
    model.fines.add(region->fines);
    model.eroded.add(region->eroded);
    model.deposited.add(region->deposited);
    model.points.add(region->points);
  }
  std::vector<ExactSum*> all;
  for (StoredSums& s : sums) {
    for (ExactSum* sum : {&s.solid, &s.erodible, &s.water, &s.fines, &s.eroded, &s.deposited,
                          &s.pending, &s.carried, &s.points}) {
      all.push_back(sum);
    }
  }
  ranks.sum(all);
  std::vector<Stored> result;
  result.reserve(sums.size());
  for (const StoredSums& s : sums) result.push_back(s.totals());
  return result;
}

Crossed CrossedSums::totals(const Ranks& ranks) const {
  CrossedSums all = *this;
  const std::array<ExactSum*, 6> each = all.all();
  ranks.sum({each.begin(), each.end()});
  return {all.water_in.value(),
          all.fines_in.value(),
          all.water_out.value(),
          all.fines_out.value(),
          all.points_in.value(),
          all.points_out.value(),
          all.water_out.minus(all.water_in),
          all.fines_out.minus(all.fines_in)};
}

template <int Dim>
MassAccounts<Dim>::MassAccounts(const Case<Dim>& c, const Grid<Dim>& grid)
    : grid_(grid),
      faces_(grid.mesh.region_names.size() + 1),
      crossed_(faces_.size()),
      boundaries_(c, grid) {
  for (const int f : grid.own_faces()) {
    const int left = grid.mesh.element_region[grid.face_left[f]];
    if (grid.is_border(f)) {
      faces_[0].push_back({f, 1.0});
      faces_[left + 1].push_back({f, 1.0});
      continue;
    }
    const int right = grid.mesh.element_region[grid.beyond(f)];
    if (left == right) continue;
    faces_[left + 1].push_back({f, 1.0});
    // At a wall the other region has its own face.
    if (!grid.is_outer(f)) faces_[right + 1].push_back({f, -1.0});
  }
}

template <int Dim>
void MassAccounts<Dim>::book(const std::vector<double>& water, const std::vector<double>& fines) {
  for (std::size_t account = 0; account < faces_.size(); ++account) {
    CrossedSums& sum = crossed_[account];
    for (const auto& [face, sign] : faces_[account]) {
      book_one(sign * water[face], sum.water_in, sum.water_out);
      book_one(sign * fines[face], sum.fines_in, sum.fines_out);
    }
  }
  boundaries_.book(water, fines);
}

template <int Dim>
void MassAccounts<Dim>::book(const RegionCrossings& crossings) {
  // Those are of all ranks.
  for (std::size_t r = 0; r < crossings.fines_out.size() && grid_.ranks().rank() == 0; ++r) {
    const double out = crossings.fines_out[r];
    CrossedSums& account = crossed_[r + 1];
    (out > 0.0 ? account.fines_out : account.fines_in).add(std::abs(out));
  }
  for (const PointCrossing& point : crossings.points) book(point);
}

template <int Dim>
void MassAccounts<Dim>::book(const PointCrossing& point) {
  const auto leave = [&](CrossedSums& account) {
    account.water_out.add(point.water_mass);
    account.fines_out.add(point.fines_mass);
    account.points_out.add(1.0);
  };
  const auto enter = [&](CrossedSums& account) {
    account.water_in.add(point.water_mass);
    account.fines_in.add(point.fines_mass);
    account.points_in.add(1.0);
  };
  CrossedSums& from = crossed_[point.from + 1];
  CrossedSums& to = crossed_[point.to + 1];
  point.from < 0 ? enter(from) : leave(from);
  point.to < 0 ? leave(to) : enter(to);
  if (point.entered_by >= 0) {
    boundaries_.book(point.entered_by, -point.water_mass, -point.fines_mass);
  }
  if (point.left_by >= 0) boundaries_.book(point.left_by, point.water_mass, point.fines_mass);
}

template <int Dim>
LedgerRow MassAccounts<Dim>::ledger(double time, const std::vector<Stored>& stored) const {
  return ledger_row(time, stored[0], crossed_[0].totals(grid_.ranks()), initial_[0]);
}

template <int Dim>
std::vector<RegionRow> MassAccounts<Dim>::region_rows(double time,
                                                      const std::vector<Stored>& stored,
                                                      const SoilMap<Dim>& soils,
                                                      double grain_density) const {
  const MaterialPoints<Dim>& points = soils.points();
  std::vector<ExactSum> sums(grid_.mesh.region_names.size());
  for (const int p : soils.points_of(grid_.own_elements())) {
    sums[grid_.mesh.element_region[points.element[p]]].add(points.volume[p]);
  }
  const std::vector<double> volume = values_of_all(grid_.ranks(), std::move(sums));
  std::vector<RegionRow> rows;
  for (std::size_t r = 0; r < volume.size(); ++r) {
    RegionRow row;
    row.region = static_cast<int>(r);
    row.porosity_mean =
        volume[r] > 0.0 ? 1.0 - stored[r + 1].solid / (grain_density * volume[r]) : 1.0;
    row.ledger =
        ledger_row(time, stored[r + 1], crossed_[r + 1].totals(grid_.ranks()), initial_[r + 1]);
    rows.push_back(row);
  }
  return rows;
}

template class MassAccounts<2>;
template class MassAccounts<3>;

}  // namespace suffuse
