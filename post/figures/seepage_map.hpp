#pragma once

/// Maps of seepage: the head with its equipotentials, or the saturation, with the phreatic line and
/// the water outside.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "figures/map_water.hpp"
#include "results/reader.hpp"
#include "values/outside_water.hpp"

namespace suffuse {

/// What a map shows.
struct SeepageMap {
  std::string title;
  std::string label;  ///< label of the colour bar, with the unit
  Mesh<2> mesh;
  std::vector<double> head;  ///< per node, m; coloured, with equipotentials
  /// Per element: whether it holds only air, where no head is drawn; empty if none does.
  std::vector<bool> air{};
  std::vector<double> saturation;  ///< per element; coloured instead of heads; or empty
  std::vector<double> pressure;    ///< per node, Pa; empty: no phreatic line
  std::vector<OutsideWater> water;
  Structures structures{};
  /// For aligned maps: range of heads that the colours cover too, m.
  std::optional<std::array<double, 2>> covered_heads{};
  std::vector<OutsideWater> room{};  ///< for aligned maps: there is room for this water too
};

/// Maps of the snapshot nearest to a time, s, or of the last. Heads are those of the nodes'
/// pressures; without gravity there is no phreatic line. Throws InputError, naming `command`, for a
/// time outside the snapshots, and for a saturation map if every soil is saturated; FileError.
SeepageMap head_map(const ResultsReader& run, const std::optional<double>& time,
                    const std::string& command = "suffuse-post figure head");
SeepageMap saturation_map(const ResultsReader& run, const std::optional<double>& time);

/// The mesh without the elements of air, with the same nodes.
Mesh<2> drawn_mesh(const SeepageMap& map);

/// The lowest and the highest head that is drawn.
std::array<double, 2> head_range(const SeepageMap& map);

/// Gives maps of heads of one run the same colours, and the model the same place in all of them.
void align_maps(std::vector<SeepageMap>& maps);

/// Values between which one colour is used, ascending: round numbers that enclose [low, high].
std::vector<double> band_levels(double low, double high);

/// Throws InputError for an unknown suffix, FileError.
void draw_seepage_map(const SeepageMap& map, const std::string& path);

}  // namespace suffuse
