#pragma once

/// Safety of the soil against being lifted by water that rises through it (heave, and the start of
/// piping at exits), over all snapshots of a run.

#include <optional>
#include <string>
#include <vector>

#include "results/reader.hpp"
#include "tables/table_output.hpp"

namespace suffuse {

/// The least safety i_cr / i of one part of the model; i: upward component of the hydraulic
/// gradient.
struct LeastSafety {
  double safety = 0.0;
  double gradient = 0.0;           ///< i
  double critical_gradient = 0.0;  ///< i_cr = (1 - n) (rho_s / rho_w - 1)
  double time = 0.0;               ///< time of the snapshot, s
  std::vector<double> place{};     ///< coordinates, m
};

/// A boundary of the scene, a region of free water, or all soil.
struct PartSafety {
  std::string name;
  /// Least safety; of a boundary over its faces through which water leaves, with the gradient in
  /// the element at the face; of free water over two layers of soil at its border. Nothing where
  /// water does not rise anywhere.
  std::optional<LeastSafety> least{};
  /// Liquid that leaves through a boundary minus what enters, at the last row of boundaries.csv,
  /// m3/s (per metre of thickness in 2D).
  std::optional<double> discharge{};
  /// Time of the first snapshot whose safety is below 1, s.
  std::optional<double> first_below{};
};

/// What a reader of the safeties must know where there is no gravity.
inline const std::string without_gravity =
    "without gravity the last axis counts as up: in a plan, heave and uplift mean nothing";

/// All soil first, then the boundaries of the scene, then the regions of free water into which
/// water rises. Throws FileError.
std::vector<PartSafety> safety_of(const ResultsReader& results);

/// The safeties as an aligned table, with an explanation.
std::string safety_text(const ResultsReader& results, const std::vector<PartSafety>& parts,
                        const TextStyle& style = {});

/// The motion of the soil at the last row of a history, which must have a row: "t = 2 h the largest
/// settlement of the soil is 0.06 m, its largest displacement 0.07 m".
std::string motion_text(const Table& history, const TimeUnit& unit);

/// Throws NumericalError, naming part, place and time, where a safety is below `least`.
void check_safety(const std::vector<PartSafety>& parts, double least);

}  // namespace suffuse
