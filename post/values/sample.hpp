#pragma once

/// Values of fields at given places and at one time, between elements and snapshots too.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// A straight line between two points, m.
struct SampleLine {
  Vector<2> from;
  Vector<2> to;
};

/// Reads `x0,y0:x1,y1` (m). Throws InputError.
SampleLine parse_line(const std::string& text);

/// Reads `a,b,c`. Throws InputError on an empty name.
std::vector<std::string> parse_field_names(const std::string& text);

/// Samples `count` >= 2 points, evenly spaced from end to end of the line. The table has columns x,
/// y and the fields, vectors as NAME_x and NAME_y.
///
/// The value in an element is, in this order of preference, that of the element's own linear field,
/// of interpolated nodal values, or the element's mean. On an edge or node it is the mean over the
/// elements of soil there, over those of free water where there is no soil. Between two snapshots
/// values are linear in time.
///
/// Throws InputError for an unknown field, a field that lives on points only, a time outside the
/// snapshots or a point outside the model.
Table sample(const ResultsReader& results, double time, const SampleLine& line, int count,
             const std::vector<std::string>& fields);

/// Names of the command and its inputs in messages.
struct SampleNames {
  std::string command = "suffuse-post sample";
  std::string time = "--time";
  std::string places = "--line";
  std::string fields = "--fields";
};

/// The same at any `positions` (m). `input_names` are used in messages.
Table sample_places(const ResultsReader& results, double time,
                    const std::vector<Vector<2>>& positions, const std::vector<std::string>& fields,
                    const SampleNames& input_names = {});

}  // namespace suffuse
