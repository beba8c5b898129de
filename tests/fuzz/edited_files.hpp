#pragma once

/// The folder in which one input after the other is laid out.

#include <string>

#include "seeds.hpp"

namespace suffuse::fuzz {

/// The case file that `input` stands for: an HDF5 file as it is, or a script of edits. Returns its
/// path, the same for all inputs.
std::string lay_out_case(const std::string& input);

/// The results folder that `input` stands for.
std::string lay_out_results(const std::string& input);

/// Closes what a damaged file left open in HDF5, so that it does not affect the next input.
void forget_files();

}  // namespace suffuse::fuzz
