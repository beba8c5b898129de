#pragma once

/// Values of fields along a straight line at one time.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

struct SampleLine {
  Vector<2> from;
  Vector<2> to;
};

/// Reads `x0,y0:x1,y1` (m). Throws InputError.
SampleLine parse_line(const std::string& text);

/// Reads `a,b,c`. Throws InputError on an empty name.
std::vector<std::string> parse_field_names(const std::string& text);

/// `count` >= 2 points from end to end; columns x, y and the fields, vectors as NAME_x, NAME_y.
///
/// In an element its own linear field is taken where there is one, else nodal values are
/// interpolated, else the element's mean holds. A point on an edge takes the mean of its elements
/// in the soil; free water counts only where no soil holds the point. Between two snapshots, values
/// are interpolated linearly in time.
///
/// Throws InputError for an unknown field, a field that only points carry, a time outside the
/// snapshots or a point outside the model.
Table sample(const ResultsReader& results, double time, const SampleLine& line, int count,
             const std::vector<std::string>& fields);

/// What messages call the command and its inputs.
struct SampleWords {
  std::string command = "suffuse-post sample";
  std::string time = "--time";
  std::string places = "--line";
  std::string fields = "--fields";
};

/// The same at any places.
Table sample_places(const ResultsReader& results, double time,
                    const std::vector<Vector<2>>& positions, const std::vector<std::string>& fields,
                    const SampleWords& words = {});

}  // namespace suffuse
