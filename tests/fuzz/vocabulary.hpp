#pragma once

/// Words of edits: names that occur in the valid files and in scenes.

#include <string>
#include <vector>

namespace suffuse::fuzz {

struct Vocabulary {
  std::vector<std::string> seeds;
  std::vector<std::string> files;       ///< of a results folder; none for cases
  std::vector<std::string> objects;     ///< of the HDF5 files
  std::vector<std::string> attributes;  ///< `OBJECT NAME`
  std::vector<std::string> pointers;    ///< into the JSON files
  std::vector<std::string> settings;    ///< `KEY=VALUE`, all of a scene's keys with many values
};

/// Every key of a scene with valid values, values at the limits, and invalid values.
std::vector<std::string> scene_settings();

/// Commands of Gmsh, above all those that run programs and write or read files.
std::vector<std::string> geometry_lines();

Vocabulary case_vocabulary();
Vocabulary results_vocabulary();

}  // namespace suffuse::fuzz
