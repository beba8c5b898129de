#pragma once

/// Scenes for tests of `suffuse-post check`.

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>

#include "checks/checks.hpp"

namespace suffuse::testing {

inline constexpr double water = 9810.0;  // unit weight, N/m3

inline std::string soil(const std::string& name, double conductivity,
                        const std::string& more = {}) {
  std::ostringstream text;
  text << "[soil." << name << "]\nporosity = 0.35\nskeleton_fraction = 0.55\n"
       << "grain_density = 2519.649\nconductivity = " << conductivity << "\n"
       << more;
  return text.str();
}

inline constexpr double bulk_weight = 19.5e3;  // of these soils, N/m3

inline std::string top(const std::string& geometry) {
  return "formulation = \"single-point\"\ngravity = [0.0, -9.81]\n" + geometry +
         "liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }\n"
         "initial.flow = \"steady\"\ntime.end = 1.0\noutput.every = 1.0\n";
}

inline std::string heads(double bottom, double above) {
  std::ostringstream text;
  text << "[[boundary]]\non = \"bottom\"\nhead = " << bottom << "\nconcentration = 0.0\n"
       << "[[boundary]]\non = \"top\"\nhead = " << above << "\nconcentration = 0.0\n";
  return text.str();
}

inline const CheckRow& row_of(const CheckReport& report, const std::string& mechanism,
                              const std::string& where = {}) {
  const auto found = std::ranges::find_if(report.rows, [&](const CheckRow& row) {
    return row.mechanism == mechanism && (where.empty() || row.where == where);
  });
  if (found == report.rows.end()) throw std::runtime_error("no row of " + mechanism);
  return *found;
}

inline constexpr const char* sand_sizes =
    "gradation = [[0.05, 0], [0.1, 15], [0.3, 50], [1.0, 85], [2.0, 95], [4.0, 100]]\n";

/// A levee that nothing flows through, 20 m wide, between the toes at x = 0 and 20 on a cover of 2
/// m and an aquifer of 10 m; the ground goes on for 100 m on both sides.
inline std::string levee_ground() {
  return "Point(1) = {-100, -12, 0}; Point(2) = {120, -12, 0}; Point(3) = {120, -2, 0};\n"
         "Point(4) = {-100, -2, 0}; Point(5) = {120, 0, 0}; Point(6) = {20, 0, 0};\n"
         "Point(7) = {0, 0, 0}; Point(8) = {-100, 0, 0};\n"
         "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
         "Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 7}; Line(8) = {7, 8};\n"
         "Line(9) = {8, 4};\n"
         "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
         "Curve Loop(2) = {-3, 5, 6, 7, 8, 9}; Plane Surface(2) = {2};\n"
         "Physical Surface(\"sand\") = {1}; Physical Surface(\"clay\") = {2};\n"
         "Physical Curve(\"land\") = {6}; Physical Curve(\"river\") = {8};\n";
}

inline std::string levee_scene(const std::string& check) {
  return top("geometry.file = \"levee.geo\"\nmesh.size = 2.0\n") + check +
         soil("sand", 1e-4, sand_sizes) + soil("clay", 1e-6) +
         "[[boundary]]\non = \"river\"\nhead = 3.0\nconcentration = 0.0\n"
         "[[boundary]]\non = \"land\"\nhead = 0.0\nconcentration = 0.0\n";
}

}  // namespace suffuse::testing
