#pragma once

/// Values of fields at given places and at one time, between elements and snapshots too.

#include <string>
#include <vector>

#include "results/reader.hpp"

namespace suffuse {

/// Two coordinates in a plane model, three in others, m.
using Position = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;

/// A straight line between two points.
struct SampleLine {
  Position from;
  Position to;
};

/// Reads `x0,y0:x1,y1` or `x0,y0,z0:x1,y1,z1` (m). Throws InputError, naming `command` and
/// `option`.
SampleLine parse_line(const std::string& text, const std::string& command = "suffuse-post sample",
                      const std::string& option = "--line");

/// Reads `x,y` or `x,y,z` (m). Throws InputError.
Position parse_place(const std::string& text);

/// Reads `a,b,c`. Throws InputError on an empty name.
std::vector<std::string> parse_field_names(const std::string& text);

/// `read_time`. Throws InputError, naming `command`, for a text that is no time.
double parse_time(const std::string& text, const std::string& command);

/// Times of all snapshots for `all`, otherwise those of `t1,t2,...`, in s or with a unit each.
/// Throws InputError.
std::vector<double> parse_times(const ResultsReader& results, const std::string& text);

/// `count` >= 2 places, evenly spaced from end to end of the line. Throws InputError.
std::vector<Position> places_on(const SampleLine& line, int count);

struct SampleRequest {
  std::vector<double> times;        ///< s
  std::vector<Position> positions;  ///< places, with as many coordinates as the model
  std::vector<std::string> fields;
  bool change = false;  ///< sample changes since the start, not the fields themselves
};

/// Names of the command and its inputs in messages.
struct SampleNames {
  std::string command = "suffuse-post sample";
  std::string time = "--time";
  std::string places = "--line";
  std::string fields = "--fields";
};

/// Samples fields at places and times. The table has a row per time and place, and columns t, x, y,
/// in three dimensions z, and the fields, vectors as NAME_x, NAME_y and NAME_z.
///
/// The value in an element is, in this order of preference, that of the element's own linear field,
/// of interpolated nodal values, or the element's mean. On an edge or node it is the mean over the
/// elements of soil there, over those of free water where there is no soil. Between two snapshots
/// values are linear in time.
///
/// Throws InputError for an unknown field, a field of points only, a time outside the
/// snapshots, a point outside the model or of another dimension.
Table sample(const ResultsReader& results, const SampleRequest& request,
             const SampleNames& input_names = {});

}  // namespace suffuse
