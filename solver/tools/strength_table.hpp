#pragma once

/// The mode --strength-reduction: the factor of safety of a case at its start, or in the states of
/// a run.

#include <string>

#include "case/case_file.hpp"
#include "tools/failing_soil.hpp"

namespace suffuse {

struct StrengthReductionOptions {
  std::string state;         ///< results folder; empty: the start of the case
  std::string time;          ///< of the state, s; "all": every snapshot; empty: the last
  std::string output = "-";  ///< CSV; `-`: standard output
  /// VTKHDF file of the mechanism of failure on the mesh; empty: none. Only for one state.
  std::string mechanism;
  FailingSoil failing;
  Displacements displacements = Displacements::linear;
  int threads = 1;
  bool quiet = false;  ///< only warnings on standard error
};

/// Writes a complete table, or nothing, with a row per state that has a factor: `t`, `factor`,
/// `holds`, `fails`, `trials`, `iterations`, `fines_left`, `displacement_max`. Prints each factor
/// with the body that fails on standard error. The file of the mechanism has the displacement in
/// the trial of the smallest factor that fails, and its shear strain per element, both over the
/// largest displacement. Throws InputError if no soil has a strength, if a region that is to fail
/// has none, or if the state has other points or no such time. Throws NumericalError when nothing
/// holds the soil, and, after the table has been written, for states without a factor: soil that
/// fails with any strength, or undecided trials. Throws FileError.
template <int Dim>
void run_strength_reduction(const Case<Dim>& c, const StrengthReductionOptions& options);

}  // namespace suffuse
