#pragma once

/// The pieces of the mesh without a prescribed pressure, in saturated soil.

#include "mixed/mixed_stage.hpp"

namespace suffuse {

/// Surplus of inflow and sources of each sealed piece, m3/s. Without storage these must cancel:
/// round-off is spread over the piece. Throws NumericalError if the surplus is larger.
template <int Dim>
std::vector<double> balance_sealed_pieces(MixedStage<Dim>& stage) {
  const Grid<Dim>& grid = stage.model.grid;
  const FluxCorrection<Dim>& correction = stage.faces.correction();
  std::vector<double> surplus(correction.sealed_piece_count(), 0.0);
  if (surplus.empty()) return surplus;

  const std::vector<int>& piece = correction.sealed_piece();
  std::vector<double> gross(surplus.size(), 0.0);
  std::vector<double> volume(surplus.size(), 0.0);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (piece[e] < 0) continue;
    surplus[piece[e]] += stage.net_source[e];
    gross[piece[e]] += std::abs(stage.net_source[e]);
    volume[piece[e]] += grid.volume[e];
  }
  for (int f = 0; f < grid.face_count(); ++f) {
    const int p = piece[grid.face_left[f]];
    if (p < 0 || !grid.is_outer(f)) continue;
    surplus[p] += stage.inflow(f);
    gross[p] += std::abs(stage.inflow(f));
  }
  for (std::size_t p = 0; p < surplus.size(); ++p) {
    if (stage.stores(correction.sealed_root()[p])) continue;
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
    if (piece[e] >= 0 && !stage.stores(correction.sealed_root()[piece[e]])) {
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
  std::vector<double> stored(surplus.size(), 0.0);
  std::vector<double> capacity(surplus.size(), 0.0);
  for (int e = 0; e < grid.mesh.element_count(); ++e) {
    if (piece[e] < 0) continue;
    for (const int f : grid.element_face[e]) stored[piece[e]] += stage.storage[e] * rise[f];
    capacity[piece[e]] += (Dim + 1) * stage.storage[e];
    if (stage.mean_storage.empty()) continue;
    stored[piece[e]] += stage.stored_in_mean(e, [&](int f) { return rise[f]; });
    capacity[piece[e]] += stage.mean_storage[e];
  }
  std::vector<double> shift(surplus.size());
  for (std::size_t p = 0; p < shift.size(); ++p) {
    const int held = grid.element_face[stage.faces.correction().sealed_root()[p]][0];
    shift[p] = capacity[p] > 0.0 ? (surplus[p] - stored[p]) / capacity[p]
                                 : -(stage.base.face_pressure[held] + rise[held]);
  }
  for (int f = 0; f < grid.face_count(); ++f) {
    const int p = piece[grid.face_left[f]];
    if (p >= 0) rise[f] += shift[p];
  }
}

}  // namespace suffuse
