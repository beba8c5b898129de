#pragma once

#include <string>

namespace suffuse::test {

/// Folders of the source and of the build: the data of the tests (tests/data), the source, and the
/// programs. One file of the build folder holds them, so that a compiler cache serves the tests of
/// checkouts in other folders.
std::string data_folder();
std::string source_folder();
std::string program_folder();

}  // namespace suffuse::test
