#include "tables/discharge_text.hpp"

#include <cstdio>

#include "files/number_text.hpp"

namespace suffuse {
namespace {

/// Six digits show an interval of 0.01 %.
std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

std::string discharge_text(const ResultsReader& results) {
  const Table history = results.history();
  if (!history.has("flux_out_low")) return "";  // of an earlier version
  const auto& low = history.column("flux_out_low");
  const auto& high = history.column("flux_out_high");
  const auto& estimate = history.column("flux_out_estimate");
  for (std::size_t row = history.rows(); row-- > 0;) {
    const bool is_bound = high[row] > 0.0;
    if (!is_bound && !(estimate[row] > 0.0)) continue;
    const std::string start = "Q = " + digits(history.column("flux_out")[row]) +
                              (results.dimension() == 2 ? " m3/s per m" : " m3/s") +
                              " at t = " + number_text(history.column("t")[row]) + " s, ";
    if (is_bound) return start + "between " + digits(low[row]) + " and " + digits(high[row]);
    return start + "by an estimate of the mesh's error to +- " + digits(estimate[row]);
  }
  return "";
}

}  // namespace suffuse
