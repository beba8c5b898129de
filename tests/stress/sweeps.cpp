#include <algorithm>
#include <iterator>

#include "stress/sweep_parts.hpp"

namespace suffuse::stress {

std::vector<Sweep> all_sweeps() {
  std::vector<Sweep> result;
  for (std::vector<Sweep> some : {flow_sweeps(), mesh_sweeps(), transport_sweeps(),
                                  water_case_sweeps(), soil_case_sweeps()}) {
    std::ranges::move(some, std::back_inserter(result));
  }
  for (Sweep (*const one)() :
       {seepage_sweep, soils_sweep, lengths_sweep, motion_sweep, space_motion_sweep, space_sweep}) {
    result.push_back(one());
  }
  return result;
}

}  // namespace suffuse::stress
