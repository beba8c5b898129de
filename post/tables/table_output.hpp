#pragma once

/// Tables as users get them: a unit behind each name, and time in the unit of choice.

#include <string>
#include <vector>

#include "files/time_unit.hpp"
#include "results/reader.hpp"

namespace suffuse {

/// Throws InputError, naming `command`, for another word.
TimeUnit parse_time_unit(const std::string& word, const std::string& command);
/// "s|min|h|d|a"
std::string time_unit_words();

/// Unit of a column of the results' tables: "kg/m" where a mass is per metre of thickness, "-" for
/// a number without one; empty for a name that they do not have.
std::string column_unit(const std::string& name, int dimension);
/// The column that is most likely meant by a name that no table has: for a name of an earlier
/// version the present name, otherwise the closest of `known`; empty where none is close.
std::string closest_column(const std::string& name, const std::vector<std::string>& known);
/// "kg/m" from "kg" in 2D, "-" from "1".
std::string shown_unit(const std::string& unit, int dimension);

/// How a text with times and limits is written.
struct TextStyle {
  TimeUnit time{};      ///< unit of its times
  bool colors = false;  ///< for a terminal: exceeded limits are bold and red
};
/// A line about an exceeded limit.
std::string alarm_line(const std::string& line, const TextStyle& style);

/// A coordinate, m; 0 where it is round-off, which no drawing has: below 1e-12 m.
double clean_coordinate(double x);
/// A place as text, m: "(1.5, 0.25)".
std::string place_text(const std::vector<double>& place);

/// Text padded to `width` letters: aligned to the right, or to the left for a negative width.
std::string padded(const std::string& text, int width);

/// The table with units, and its times in the unit.
Table with_units(Table table, int dimension, const TimeUnit& time);
std::vector<NamedTable> with_units(std::vector<NamedTable> tables, int dimension,
                                   const TimeUnit& time);

/// A table that a user gives, with times in seconds. Throws InputError, naming its path, for an
/// unknown unit of time.
Table with_seconds(Table table, const std::string& path);

}  // namespace suffuse
