#pragma once

/// Pictures of one field on the model.

#include <optional>
#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// What to show. A field that lives in several places is taken from elements, else nodes, else
/// solid points, else liquid points.
struct RenderRequest {
  std::string field;
  std::string on;                              ///< "cell", "node", "solid", "liquid" or empty
  std::optional<double> time;                  ///< s; the nearest snapshot; without it the last
  bool all = false;                            ///< every snapshot, in one range of colours
  std::optional<std::array<double, 2>> range;  ///< of the colours; without it that of the values
  std::string output;  ///< .png; a number is put in front of that with `all`
};

/// Reads `LO,HI`, LO < HI. Throws InputError.
std::array<double, 2> parse_range(const std::string& text);

/// Draws elements in flat colours, nodal and element-vertex fields smoothly, points as discs over
/// the mesh; vectors by their magnitude. Fields that count kinds (saturation_state, region) get a
/// legend of names, others a colour bar. Returns the paths written. Throws InputError (which lists
/// the fields and where they live), FileError.
std::vector<std::string> render(const ResultsReader& results, const RenderRequest& request);

}  // namespace suffuse
