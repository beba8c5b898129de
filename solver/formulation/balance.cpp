#include "formulation/balance.hpp"

namespace suffuse {
namespace {

void book_one(double outward, CompensatedSum& in, CompensatedSum& out) {
  if (outward > 0.0) out.add(outward);
  if (outward < 0.0) in.add(-outward);
}

double relative(double residual, double initial) {
  return initial > 0.0 ? residual / initial : residual;
}

}  // namespace

template <int Dim>
BoundaryAccounts<Dim>::BoundaryAccounts(const Grid<Dim>& grid)
    : faces_(grid.mesh.region_names.size() + 1) {
  for (int f = 0; f < grid.face_count(); ++f) {
    const int left = grid.mesh.element_region[grid.face_left[f]];
    if (grid.is_outer(f)) {
      faces_[0].push_back({f, 1.0});
      faces_[left + 1].push_back({f, 1.0});
      continue;
    }
    const int right = grid.mesh.element_region[grid.face_right[f]];
    if (left == right) continue;
    faces_[left + 1].push_back({f, 1.0});
    faces_[right + 1].push_back({f, -1.0});
  }
}

template <int Dim>
void BoundaryAccounts<Dim>::book(const std::vector<double>& water, const std::vector<double>& fines,
                                 std::vector<CrossedSums>& sums) const {
  for (std::size_t account = 0; account < faces_.size(); ++account) {
    CrossedSums& sum = sums[account];
    for (const auto& [face, sign] : faces_[account]) {
      book_one(sign * water[face], sum.water_in, sum.water_out);
      book_one(sign * fines[face], sum.fines_in, sum.fines_out);
    }
  }
}

LedgerRow ledger_row(double time, const Stored& stored, const Crossed& crossed,
                     const Stored& initial) {
  LedgerRow row;
  row.t = time;
  row.solid = stored.solid;
  row.erodible = stored.erodible;
  row.water = stored.water;
  row.fines = stored.fines;
  row.eroded = stored.eroded;
  row.water_in = crossed.water_in;
  row.fines_in = crossed.fines_in;
  row.water_out = crossed.water_out;
  row.fines_out = crossed.fines_out;
  row.pending = stored.pending;
  row.points = stored.points;
  row.points_in = crossed.points_in;
  row.points_out = crossed.points_out;
  row.residual_water = relative((stored.water - initial.water) + crossed.water_net, initial.water);
  row.residual_grains = relative((stored.solid - initial.solid) + (stored.fines - initial.fines) +
                                     stored.pending + crossed.fines_net,
                                 initial.solid + initial.fines);
  return row;
}

template class BoundaryAccounts<2>;

}  // namespace suffuse
