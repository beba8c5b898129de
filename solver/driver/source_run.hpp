#pragma once

/// The run named by `initial.from` of a scene, from whose last state another run starts.

#include <optional>
#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "driver/plan.hpp"
#include "formulation/earlier_state.hpp"

namespace suffuse {

template <int Dim>
struct SourceRun {
  std::string folder;  ///< of its results
  EarlierState<Dim> state;
  /// For plan and run.json: origin, time and digest of the state, and differences of the scenes.
  std::vector<std::string> sentences;
};

/// Whether two cases have the same mesh, except boundaries, and the same solid points.
template <int Dim>
bool have_same_points(const Case<Dim>& a, const Case<Dim>& b);

/// The last state of a run and its time, s.
template <int Dim>
struct LastState {
  double time = 0.0;
  std::string digest;  ///< of the restart point
  EarlierState<Dim> state;
};

/// Reads the newest state that a run of this case, whose results are in `folder`, can go on from.
/// Throws FileError if there is none.
template <int Dim>
LastState<Dim> read_last_state(const std::string& folder, const Case<Dim>& c,
                               const SolverOptions& options);

/// Reads the last state of the run; nothing if the scene names none. Throws InputError if the run
/// is not done, or has another formulation, mesh, water or soil; FileError if its files cannot be
/// read. On several ranks each gets its part of the state.
template <int Dim>
std::optional<SourceRun<Dim>> read_source_run(const Case<Dim>& c, const SolverOptions& options);

}  // namespace suffuse
