#pragma once

/// The fuzzed functions. Each takes any input and returns if the sources dealt with it as they
/// promise: they accepted it, or refused it with an error of their own that has a message. Anything
/// else is a finding: another exception, a failed check below (a std::logic_error), or an error
/// that a sanitizer stops.

#include <string>

namespace suffuse::fuzz {

/// A scene: TOML, in which the lines that start with `#set ` are `--set` arguments as well.
void try_scene(const std::string& input);

/// A case file: a script of edits to a valid one (see file_edits.hpp), or the bytes of an HDF5
/// file.
void try_case(const std::string& input);

/// A results folder: a script of edits to the files of a valid one. Asks everything the post stage
/// can ask of a results folder.
void try_results(const std::string& input);

/// A case file as in try_case. If the reader takes it, it must run: plans it and takes a few steps.
void try_model(const std::string& input);

/// A geometry in Gmsh's language, or a .msh or STEP file by how it begins; `@` stands for its
/// folder. Whatever it has Gmsh do, no command is run and no file is made, changed or removed.
void try_geometry(const std::string& input);

}  // namespace suffuse::fuzz
