#pragma once

/// The flow net: equipotentials, and streamlines with equal discharge between them.

#include <optional>
#include <string>
#include <vector>

#include "figures/seepage_map.hpp"
#include "values/stream_function.hpp"

namespace suffuse {

struct FlowNet {
  SeepageMap map;         ///< heads, phreatic line, water outside
  StreamFunction stream;  ///< stream function of the snapshot
  int tubes = 0;          ///< N_f: each tube carries 1/N_f of the discharge
  int drops = 0;          ///< N_d: each drop takes 1/N_d of the whole fall of the head
  std::vector<std::string> caption;
};

/// Numbers of tubes and drops with which the tubes of a soil become rows of squares.
struct SquareNet {
  int tubes;
  int drops;
};

/// `drops_per_tube` is k H / q. The net has about forty fields. The number of tubes is `tubes` if
/// given, otherwise the one for which the number of drops is nearest to a whole number.
SquareNet square_net(double drops_per_tube, const std::optional<int>& tubes);

/// The flow net of the snapshot nearest to a time, s, or of the last. Throws InputError for a time
/// outside the snapshots, tubes that are not 1 to 100, liquid at rest and a flow that has no stream
/// function; FileError. Where soils conduct differently there are no squares, and the net has 6
/// tubes and 12 drops.
FlowNet flow_net(const ResultsReader& run, const std::optional<double>& time,
                 const std::optional<int>& tubes);

/// Throws InputError for an unknown suffix, FileError.
void draw_flow_net(const FlowNet& net, const std::string& path);

}  // namespace suffuse
