#pragma once

/// The figures of the paper, from results.

#include <string>
#include <vector>

#include "chart.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Names that `make_figure` knows.
std::vector<std::string> figure_names();

/// "porosity" is Fig. 4: mean porosity of the eroding soil against time. "masses" is Fig. 7: solid,
/// eroded, liquid and total mass of the eroding soil in closed accounting (in the soil, plus what
/// left, less what entered). Both with the exact curves of each scene's own parameters. Without
/// eroding soil, all soil counts. Throws InputError for another name.
Chart make_figure(const std::string& name, const std::vector<ResultsReader>& runs);

}  // namespace suffuse
