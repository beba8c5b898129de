#pragma once

/// The run that `initial.from` of a scene names, from whose last state another one starts.

#include <optional>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "formulation/earlier_state.hpp"

namespace suffuse {

template <int Dim>
struct SourceRun {
  std::string folder;  ///< of its results
  EarlierState<Dim> state;
  /// For plan and run.json: from where the state is, its time and digest, and how the scenes
  /// differ.
  std::vector<std::string> sentences;
};

/// Whether two cases have the same mesh, but for its boundaries, and the same solid points.
template <int Dim>
bool have_same_points(const Case<Dim>& a, const Case<Dim>& b);

/// Reads the last state of the run; nothing where the scene names none. Throws InputError where the
/// run is not done, or is of another formulation, mesh, water or soil; FileError where its files
/// cannot be read.
template <int Dim>
std::optional<SourceRun<Dim>> read_source_run(const Case<Dim>& c, int threads);

}  // namespace suffuse
