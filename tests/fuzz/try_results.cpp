#include <algorithm>
#include <cstddef>

#include "edited_files.hpp"
#include "files/layout.hpp"
#include "refusal.hpp"
#include "results/reader.hpp"
#include "results/restart_point.hpp"
#include "results/writer.hpp"
#include "targets.hpp"

namespace suffuse::fuzz {
namespace {

constexpr std::size_t max_snapshots = 3;

/// Number of cells, nodes or points that have values.
template <int Dim>
std::size_t entities(const ResultsReader& results, const Mesh<Dim>& mesh, const std::string& where,
                     std::size_t index) {
  if (where == "cell" || where == "element_vertex") return mesh.elements.size();
  if (where == "node") return mesh.nodes.size();
  return results.point_positions<Dim>(index, where).size();
}

template <int Dim>
void look_at_fields(const ResultsReader& results, const Mesh<Dim>& mesh, std::size_t index,
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
  const bool both = results.scene().scene.formulation == Formulation::double_point;
  with_mesh(results, [&](const auto& mesh) {
    for (std::size_t i = 0; i < std::min(max_snapshots, results.times().size()); ++i) {
      for (const std::string where : {"cell", "node", "element_vertex", "solid", "liquid"}) {
        if (where == "liquid" && !both) continue;
        static_cast<void>(is_taken(folder, [&] { look_at_fields(results, mesh, i, where); }));
      }
    }
  });
}

/// Does what the solver does with a folder when it resumes a run, except reading the state itself:
/// only a file with the right digest gets that far.
template <int Dim>
void go_on_in(const std::string& folder) {
  const Case<Dim> c = read_case<Dim>(layout::in_folder(folder, layout::case_copy));
  const Scene& scene = c.document.scene;
  check_results_folder(folder, scene.name);
  static_cast<void>(is_finished(folder));
  static_cast<void>(differences_from_run(folder, c));
  FolderLock lock = lock_for_results(folder, c, Replace::any);
  const FoundRestart found =
      newest_restart_point(folder, scene.formulation == Formulation::double_point,
                           table_files(scene, c.mesh.region_names.size()));
  if (!found.point) return;
  ResultsWriter<Dim> writer(folder, c, std::move(lock), *found.point);
  writer.append_history({});
  writer.append_ledger({});
  writer.write_run_info({});
}

void go_on(const std::string& folder) {
  const int dimension = read_case_dimension(layout::in_folder(folder, layout::case_copy));
  dimension == 3 ? go_on_in<3>(folder) : go_on_in<2>(folder);
}

}  // namespace

void try_results(const std::string& input) {
  const std::string folder = lay_out_results(input);
  static_cast<void>(is_taken(folder, [&] { look_at(ResultsReader(folder)); }));
  static_cast<void>(is_taken([&] { go_on(folder); }));
  forget_files();
}

}  // namespace suffuse::fuzz
