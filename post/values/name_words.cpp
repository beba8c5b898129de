#include "values/name_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace suffuse {
namespace {

/// Columns whose words are not those of the name itself.
constexpr auto irregular_columns = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"t", "time"},
    {"dt", "time step"},
    {"flux_x", "Darcy flux along x"},
    {"flux_y", "Darcy flux along y"},
    {"flux_z", "Darcy flux along z"},
    {"porosity_mean", "mean porosity"},
    {"flux_in", "flux that enters the model"},
    {"flux_out", "flux that leaves the model"},
    {"flux_out_low", "lower bound of the flux that leaves the model"},
    {"flux_out_high", "upper bound of the flux that leaves the model"},
    {"empty_elements", "elements without liquid points"},
    {"empty_elements_total", "elements without liquid points, added up over the steps"},
    {"concentration_out", "concentration of the outflow"},
    {"concentration_min", "least concentration"},
    {"concentration_max", "largest concentration"},
    {"pressure_min", "least pressure"},
    {"pressure_max", "largest pressure"},
    {"speed_max", "largest speed of the liquid"},
    {"eos_error", "error of the equation of state"},
    {"turbidity_out", "turbidity of the outflow"},
    {"turbidity_max", "largest turbidity of the outflow"},
    {"eroded", "eroded fines"},
    {"deposited", "deposited fines"},
    {"fines", "fines in the liquid"},
    {"fines_in", "fines that entered"},
    {"fines_out", "fines that left"},
    {"fines_out_percent", "fines that left, of those at the start"},
    {"solid_out_percent", "fines that left, of all solid at the start"},
    {"fines_lost_percent", "fines lost, of those that could erode"},
    {"conductivity_ratio", "conductivity over that at the start"},
    {"power", "power that water dissipates in the soil"},
    {"energy", "energy that water has dissipated in the soil"},
    {"settlement_max", "largest settlement"},
    {"displacement_max", "largest displacement"},
    {"newton_iterations", "Newton iterations"},
    {"inertia", "inertia over the loads"},
    {"failure_time", "last loss of equilibrium"},
    {"solid", "solid in place"},
    {"erodible", "solid that can erode"},
    {"carried", "solid that moving soil carried in"},
    {"pending", "fines that wait at nodes"},
    {"water_in", "water that entered"},
    {"water_out", "water that left"},
    {"residual_water", "residual of the balance of water"},
    {"residual_grains", "residual of the balance of grains"},
    {"points", "liquid points"},
    {"points_in", "liquid points that entered"},
    {"points_out", "liquid points that left"},
    {"liquid_in", "liquid that entered"},
    {"liquid_out", "liquid that left"},
    {"level", "head outside"},
    {"discharge_low", "lower bound of the discharge"},
    {"discharge_high", "upper bound of the discharge"},
    {"head_mean", "mean head"},
    {"gradient", "gradient of the mean head"},
    {"volume", "liquid that has crossed"},
    {"complete_exact", "exact end of erosion"},
    {"complete_computed", "computed end of erosion"},
    {"error_solid_percent", "largest error of the solid mass"},
    {"error_eroded_percent", "largest error of the eroded mass"},
    {"error_porosity_percent", "largest error of the mean porosity"},
});

}  // namespace

std::string field_words(const std::string& name) {
  const std::size_t size = name.size();
  if (size > 2 && name[size - 2] == '_' && name.back() >= 'x' && name.back() <= 'z') {
    return field_words(name.substr(0, size - 2)) + " along " + name.back();
  }
  if (name == "darcy_flux") return "Darcy flux";
  std::string words = name;
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string column_words(const std::string& name) {
  for (const auto& [column, words] : irregular_columns) {
    if (column == name) return std::string(words);
  }
  return field_words(name);
}

std::string capitalized(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace suffuse
