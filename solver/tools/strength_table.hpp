#pragma once

/// The mode --strength-reduction: the factor of safety of a case at its start, or in the states
/// that a run has left.

#include <string>

#include "case/case_file.hpp"

namespace suffuse {

struct StrengthReductionOptions {
  std::string state;         ///< results folder; empty: the start of the case
  std::string time;          ///< of the state, s; "all": every snapshot; empty: the last
  std::string output = "-";  ///< CSV; `-`: standard output
  /// VTKHDF: how the soil fails, on the mesh; empty: none. Only for one state.
  std::string mechanism;
  int threads = 1;
  bool quiet = false;  ///< no sentences on standard error, but warnings
};

/// Writes a table with a row per state that has a factor, whole or not at all: `t`, `factor`,
/// `holds`, `fails`, `trials`, `iterations`, `fines_left`, `displacement_max`. Says each factor in
/// a sentence on standard error, with the body that fails. The file of the mechanism has the
/// displacement of the trial that fails at the smallest factor, and its shear strain per element,
/// both over the largest displacement. Throws InputError where no soil has a strength, or where the
/// state is of other points or of no such time; NumericalError when nothing holds the soil, and,
/// after the table has been written, for states without a factor: soil that fails with any
/// strength, or of which a trial decides nothing; FileError.
template <int Dim>
void run_strength_reduction(const Case<Dim>& c, const StrengthReductionOptions& options);

}  // namespace suffuse
