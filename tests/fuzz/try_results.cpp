#include <algorithm>
#include <cstddef>

#include "edited_files.hpp"
#include "refusal.hpp"
#include "results/reader.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {
namespace {

constexpr std::size_t most_snapshots = 3;

/// How many cells, nodes or points there are to have values.
std::size_t entities(const ResultsReader& results, const Mesh<2>& mesh, const std::string& where,
                     std::size_t index) {
  if (where == "cell" || where == "element_vertex") return mesh.elements.size();
  if (where == "node") return mesh.nodes.size();
  return results.point_positions(index, where).size();
}

void look_at_fields(const ResultsReader& results, const Mesh<2>& mesh, std::size_t index,
                    const std::string& where) {
  for (const std::string& name : results.field_names(index, where)) {
    static_cast<void>(is_taken(results.folder(), [&] {
      const Field field = results.field(index, where, name);
      require(field.components > 0, "a field without components");
      require(field.values.size() == entities(results, mesh, where, index) *
                                         static_cast<std::size_t>(field.components),
              "a field that is not of its mesh or points");
    }));
  }
}

void look_at(const ResultsReader& results) {
  const std::string& folder = results.folder();
  for (const auto& table :
       {&ResultsReader::history, &ResultsReader::ledger, &ResultsReader::region_ledgers}) {
    static_cast<void>(is_taken(folder, [&] {
      const Table read = (results.*table)();
      for (const auto& column : read.columns) {
        require(column.size() == read.rows(), "columns of different lengths");
      }
    }));
  }
  require(std::ranges::is_sorted(results.times()), "times that do not ascend");
  const Mesh<2> mesh = results.mesh();
  const bool both = results.scene().scene.formulation == Formulation::double_point;
  for (std::size_t i = 0; i < std::min(most_snapshots, results.times().size()); ++i) {
    for (const std::string where : {"cell", "node", "element_vertex", "solid", "liquid"}) {
      if (where == "liquid" && !both) continue;
      static_cast<void>(is_taken(folder, [&] { look_at_fields(results, mesh, i, where); }));
    }
  }
}

}  // namespace

void try_results(const std::string& input) {
  const std::string folder = lay_out_results(input);
  static_cast<void>(is_taken(folder, [&] { look_at(ResultsReader(folder)); }));
  forget_files();
}

}  // namespace suffuse::fuzz
