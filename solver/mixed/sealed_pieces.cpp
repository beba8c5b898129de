/// The mixed elements in pieces of the mesh whose pressure no boundary prescribes.

#include <cmath>
#include <sstream>

#include "common/errors.hpp"
#include "mixed/implicit_mixed.hpp"

namespace suffuse {

template <int Dim>
void ImplicitMixed<Dim>::balance_sealed_pieces(const FlowForcing<Dim>& forcing) {
  Work& w = work_;
  const int elements = grid_.mesh.element_count();
  const auto pieces = static_cast<std::size_t>(correction_->sealed_piece_count());
  if (forcing.source.empty()) {
    w.net_source.assign(elements, 0.0);
  } else {
    w.net_source = forcing.source;
  }
  w.surplus.assign(pieces, 0.0);
  // Retention and seepage faces take up what enters.
  if (pieces == 0 || is_nonlinear()) return;

  const std::vector<int>& piece = correction_->sealed_piece();
  std::vector<double> gross(pieces, 0.0);
  std::vector<double> volume(pieces, 0.0);
  for (int e = 0; e < elements; ++e) {
    if (piece[e] < 0) continue;
    w.surplus[piece[e]] += w.net_source[e];
    gross[piece[e]] += std::abs(w.net_source[e]);
    volume[piece[e]] += grid_.volume[e];
  }
  for (int f = 0; f < grid_.face_count(); ++f) {
    const int p = piece[grid_.face_left[f]];
    if (p < 0 || !grid_.is_outer(f)) continue;
    w.surplus[p] += prescribed_inflow(forcing, f);
    gross[p] += std::abs(prescribed_inflow(forcing, f));
  }
  for (std::size_t p = 0; p < pieces; ++p) {
    if (stores(correction_->sealed_root()[p])) continue;
    if (!(std::abs(w.surplus[p]) <= 1e-9 * gross[p])) {
      std::ostringstream text;
      text.precision(10);
      text << "no boundary prescribes a pressure and water is not stored, so prescribed inflow "
              "and sources must cancel; they add up to "
           << w.surplus[p] << " m3/s, of " << gross[p] << " m3/s in all";
      throw NumericalError(text.str());
    }
  }
  // The round-off that remains is spread over the piece.
  for (int e = 0; e < elements; ++e) {
    if (piece[e] >= 0 && !stores(correction_->sealed_root()[piece[e]])) {
      w.net_source[e] -= w.surplus[piece[e]] * grid_.volume[e] / volume[piece[e]];
    }
  }
}

template <int Dim>
void ImplicitMixed<Dim>::level_sealed_pieces(const MixedState<Dim>& base,
                                             std::vector<double>& rise) const {
  // To the last digit where next to no storage hardly holds the level.
  const auto pieces = static_cast<std::size_t>(correction_->sealed_piece_count());
  if (pieces == 0) return;
  const std::vector<int>& piece = correction_->sealed_piece();
  std::vector<double> stored(pieces, 0.0);
  std::vector<double> capacity(pieces, 0.0);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    if (piece[e] < 0) continue;
    for (const int f : grid_.element_face[e]) stored[piece[e]] += work_.storage[e] * rise[f];
    capacity[piece[e]] += (Dim + 1) * work_.storage[e];
    if (work_.mean_storage.empty()) continue;
    stored[piece[e]] += stored_in_mean(e, [&](int f) { return rise[f]; });
    capacity[piece[e]] += work_.mean_storage[e];
  }
  std::vector<double> shift(pieces);
  for (std::size_t p = 0; p < pieces; ++p) {
    if (capacity[p] > 0.0) {
      shift[p] = (work_.surplus[p] - stored[p]) / capacity[p];
    } else {
      const int held = grid_.element_face[correction_->sealed_root()[p]][0];
      shift[p] = -(base.face_pressure[held] + rise[held]);
    }
  }
  for (int f = 0; f < grid_.face_count(); ++f) {
    const int p = piece[grid_.face_left[f]];
    if (p >= 0) rise[f] += shift[p];
  }
}

template void ImplicitMixed<2>::balance_sealed_pieces(const FlowForcing<2>&);
template void ImplicitMixed<2>::level_sealed_pieces(const MixedState<2>&,
                                                    std::vector<double>&) const;
template void ImplicitMixed<3>::balance_sealed_pieces(const FlowForcing<3>&);
template void ImplicitMixed<3>::level_sealed_pieces(const MixedState<3>&,
                                                    std::vector<double>&) const;

}  // namespace suffuse
