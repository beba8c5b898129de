#pragma once

/// Records of the scene's probes, the state at a place, and sections, the liquid that crosses a
/// line. Makes the rows of probes.csv and sections.csv.

#include <vector>

#include "case/case_file.hpp"
#include "field/eulerian.hpp"
#include "flow/flow_solver.hpp"
#include "grid/section_line.hpp"
#include "ranks/ranks.hpp"

namespace suffuse {

template <int Dim>
class Observations {
 public:
  /// Throws InputError if a probe is outside the mesh or a section misses it. Keeps references to
  /// the case and the grid.
  Observations(const Case<Dim>& c, const Grid<Dim>& grid);

  /// Books volumes of liquid along the faces' normals, m3, in one interval of the flow.
  void book_liquid(const std::vector<double>& volumes);

  [[nodiscard]] bool has_probes() const { return !probes_.empty(); }
  /// `liquid`: pores and fines in them.
  [[nodiscard]] std::vector<ProbeRow> probe_rows(const FlowState<Dim>& flow,
                                                 const FinesState<Dim>& liquid) const;
  [[nodiscard]] std::vector<SectionRow> section_rows(const FlowState<Dim>& flow) const;

  void archive(auto& archive) {
    std::vector<ExactSum*> sums;
    for (ExactSum& volume : volumes_) sums.push_back(&volume);
    archive_sums(archive, grid_.ranks(), sums);
  }

 private:
  const Scene& scene_;
  const Grid<Dim>& grid_;
  std::vector<std::optional<PointPlace<Dim>>> probes_;  ///< in own elements of this rank
  std::vector<SectionLine> sections_;                   ///< in two dimensions
  std::vector<ExactSum> volumes_;                       ///< since the start, per section, m3
};

}  // namespace suffuse
