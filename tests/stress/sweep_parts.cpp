#include "stress/sweep_parts.hpp"

#include <sstream>

namespace suffuse::stress {

std::string number(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

std::string shown(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

std::string set(const std::string& key, double value) {
  return key + "=" + number(value);
}

std::string pairs(const std::vector<std::pair<double, double>>& values) {
  std::string text = "[";
  for (const auto& [t, value] : values) text += "[" + number(t) + ", " + number(value) + "], ";
  return text + "]";
}

Changes joined(Changes first, const Changes& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

Changes erosion(const std::string& law, const Span& span) {
  const double rate = law == "constant"      ? 0.1 / (0.6 * span.end)
                      : law == "logarithmic" ? 0.5 / span.end
                      : law == "first-order" ? 3.0 / span.end
                                             : 300.0 / span.end;  // 1/m, at |q| = 0.01 m/s
  return {"soil.specimen.erosion={law=\"" + law + "\", rate=" + number(rate) +
          ", start=" + number(0.1 * span.end) + "}"};
}

double layered_discharge(const std::vector<double>& conductivities) {
  double resistance = 0.0;
  for (const double k : conductivities) {
    resistance += 1.0 / static_cast<double>(conductivities.size()) / k;
  }
  return 0.5 * 6000.0 / (1000.0 * 9.81) / resistance;
}

}  // namespace suffuse::stress
