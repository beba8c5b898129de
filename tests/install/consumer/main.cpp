/// Prints the last time of a run, its solid mass then, and its mean porosity.

#include <cstdio>
#include <numeric>

#include "results/reader.hpp"

int main(int, char** argv) {
  const suffuse::ResultsReader run(argv[1]);
  const suffuse::Table ledger = run.ledger();
  const std::size_t last = run.times().size() - 1;
  const std::vector<double> porosity = run.field(last, "cell", "porosity").values;
  const double mean = std::accumulate(porosity.begin(), porosity.end(), 0.0) / porosity.size();
  std::printf("%zu elements, %g s, %.6g kg, %.6g\n", run.mesh().elements.size(), run.times()[last],
              ledger.column("solid").back(), mean);
}
