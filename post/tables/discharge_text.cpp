#include "tables/discharge_text.hpp"

#include "common/short_number.hpp"
#include "files/number_text.hpp"

namespace suffuse {
std::string discharge_text(const ResultsReader& results) {
  const Table history = results.history();
  if (!history.has("flux_out_low")) return "";  // of an earlier version
  const auto& low = history.column("flux_out_low");
  const auto& high = history.column("flux_out_high");
  const auto& estimate = history.column("flux_out_estimate");
  for (std::size_t row = history.rows(); row-- > 0;) {
    const bool is_bound = high[row] > 0.0;
    if (!is_bound && !(estimate[row] > 0.0)) continue;
    const std::string start = "Q = " + short_number(history.column("flux_out")[row]) +
                              (results.dimension() == 2 ? " m3/s per m" : " m3/s") +
                              " at t = " + number_text(history.column("t")[row]) + " s, ";
    if (is_bound)
      return start + "between " + short_number(low[row]) + " and " + short_number(high[row]);
    return start + "by an estimate of the mesh's error to +- " + short_number(estimate[row]);
  }
  return "";
}

}  // namespace suffuse
