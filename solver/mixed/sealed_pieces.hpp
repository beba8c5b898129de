#pragma once

/// The pieces of the mesh without a prescribed pressure, in saturated soil.

#include "mixed/mixed_stage.hpp"

namespace suffuse {

/// Whether an element of each sealed piece stores liquid as its pressure rises: this fixes the
/// level of the pressure.
/// \param side_storage  of the sides of elements, in addition; may be empty
template <int Dim>
std::vector<char> pieces_that_store(const MixedStage<Dim>& stage,
                                    const ElementField<Dim>& side_storage = {}) {
  const std::vector<int>& piece = stage.faces.correction().sealed_piece();
  std::vector<double> stores(stage.faces.correction().sealed_piece_count(), 0.0);
  for (std::size_t e = 0; e < piece.size() && !stores.empty(); ++e) {
    const auto positive = [](double s) { return s > 0.0; };
    const bool at_sides = !side_storage.empty() && std::ranges::any_of(side_storage[e], positive);
    const bool is_stored = at_sides || stage.stores(static_cast<int>(e));
    if (piece[e] >= 0 && is_stored) stores[piece[e]] = 1.0;
  }
  stage.model.grid.ranks().largest(stores);
  return {stores.begin(), stores.end()};
}

/// Surplus of inflow and sources of each sealed piece, m3/s. Without storage these must cancel:
/// round-off is spread over the piece. Throws NumericalError if the surplus is larger.
template <int Dim>
std::vector<double> balance_sealed_pieces(MixedStage<Dim>& stage) {
  const Grid<Dim>& grid = stage.model.grid;
  const FluxCorrection<Dim>& correction = stage.faces.correction();
  std::vector<double> surplus(correction.sealed_piece_count(), 0.0);
  if (surplus.empty()) return surplus;

  const std::vector<int>& piece = correction.sealed_piece();
  std::vector<ExactSum> surplus_sum(surplus.size());
  std::vector<ExactSum> gross_sum(surplus.size());
  std::vector<ExactSum> volume_sum(surplus.size());
  for (const int e : grid.own_elements()) {
    if (piece[e] < 0) continue;
    surplus_sum[piece[e]].add(stage.net_source[e]);
    gross_sum[piece[e]].add(std::abs(stage.net_source[e]));
    volume_sum[piece[e]].add(grid.volume[e]);
  }
  for (const int f : grid.own_faces()) {
    const int p = piece[grid.face_left[f]];
    if (p < 0 || !grid.is_outer(f)) continue;
    surplus_sum[p].add(stage.inflow(f));
    gross_sum[p].add(std::abs(stage.inflow(f)));
  }
  surplus = values_of_all(grid.ranks(), surplus_sum);
  const std::vector<double> gross = values_of_all(grid.ranks(), gross_sum);
  const std::vector<double> volume = values_of_all(grid.ranks(), volume_sum);
  const std::vector<char> stores = pieces_that_store(stage);
  for (std::size_t p = 0; p < surplus.size(); ++p) {
    if (stores[p] != 0) continue;
    if (!(std::abs(surplus[p]) <= 1e-9 * gross[p])) {
      std::ostringstream text;
      text.precision(10);
      text << "no boundary prescribes a pressure and water is not stored, so prescribed inflow "
              "and sources must cancel; they add up to "
           << surplus[p] << " m3/s, of " << gross[p] << " m3/s in all";
      throw NumericalError(text.str());
    }
  }
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (piece[e] >= 0 && stores[piece[e]] == 0) {
      stage.net_source[e] -= surplus[piece[e]] * grid.volume[e] / volume[piece[e]];
    }
  }
  return surplus;
}

/// Shifts the pressures of each sealed piece so that the water it stores equals its surplus
/// exactly, even if it has next to no storage. `rise`: of the pressures, per face.
template <int Dim>
void level_sealed_pieces(const MixedStage<Dim>& stage, const std::vector<double>& surplus,
                         std::vector<double>& rise) {
  if (surplus.empty()) return;
  const Grid<Dim>& grid = stage.model.grid;
  const std::vector<int>& piece = stage.faces.correction().sealed_piece();
  std::vector<ExactSum> stored_sum(surplus.size());
  std::vector<ExactSum> capacity_sum(surplus.size());
  std::vector<ExactSum> held_sum(surplus.size());  // the pressure at one face
  for (const int e : grid.own_elements()) {
    if (piece[e] < 0) continue;
    for (const int f : grid.element_face[e]) stored_sum[piece[e]].add(stage.storage[e] * rise[f]);
    capacity_sum[piece[e]].add((Dim + 1) * stage.storage[e]);
    stored_sum[piece[e]].add(stage.stored_in_mean(e, [&](int f) { return rise[f]; }));
    if (!stage.mean_storage.empty()) capacity_sum[piece[e]].add(stage.mean_storage[e]);
  }
  for (std::size_t p = 0; p < surplus.size(); ++p) {
    const int root = stage.faces.correction().sealed_root()[p];
    if (root < 0) continue;  // on another rank
    const int held = grid.element_face[root][0];
    held_sum[p].add(stage.base.face_pressure[held] + rise[held]);
  }
  const std::vector<double> stored = values_of_all(grid.ranks(), stored_sum);
  const std::vector<double> capacity = values_of_all(grid.ranks(), capacity_sum);
  const std::vector<double> pressure = values_of_all(grid.ranks(), held_sum);
  std::vector<double> shift(surplus.size());
  for (std::size_t p = 0; p < shift.size(); ++p) {
    shift[p] = capacity[p] > 0.0 ? (surplus[p] - stored[p]) / capacity[p] : -pressure[p];
  }
  for (int f = 0; f < grid.face_count(); ++f) {
    const int p = piece[grid.face_left[f]];
    if (p >= 0) rise[f] += shift[p];
  }
}

}  // namespace suffuse
