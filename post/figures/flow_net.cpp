#include "figures/flow_net.hpp"

#include <vtkNew.h>

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "drawing/chart_legend.hpp"
#include "drawing/line_labels.hpp"
#include "drawing/model_view.hpp"
#include "drawing/picture.hpp"
#include "drawing/ticks.hpp"
#include "drawing/type_size.hpp"
#include "figures/map_water.hpp"
#include "physics/head.hpp"
#include "values/fields.hpp"
#include "values/snapshot_choice.hpp"

namespace suffuse {
namespace {

using Layout = PictureLayout;
const std::string flow_net_command = "suffuse-post figure flownet";
constexpr Color stream_blue{0.1, 0.35, 0.9};
constexpr Color boundary_grey{0.45, 0.45, 0.45};
constexpr float potential_width = 1.2F;
constexpr float flow_net_width = 2.2F;
constexpr float room_above_net = 100.0F;
constexpr int max_tubes = 100;
constexpr int max_drops = 200;
/// The picture has a note if the misfit is larger than this.
constexpr double noticed_net_misfit = 0.01;
constexpr double noticed_weight = 0.001;

/// Geometric mean of the conductivities of both directions, m/s: with it, fields are squares in a
/// section that is stretched.
double mean_conductivity(const Soil& soil) {
  return soil.conductivity * std::sqrt(soil.anisotropy());
}

std::vector<const Soil*> soils_of(const ResultsReader& run, const Mesh<2>& mesh) {
  std::vector<const Soil*> soils;
  for (const auto& region : mesh.region_names) {
    const Soil* soil = run.scene().scene.find_soil(region);
    if (soil != nullptr) soils.push_back(soil);
  }
  return soils;
}

bool conduct_alike(const std::vector<const Soil*>& soils) {
  return std::ranges::all_of(soils, [&](const Soil* soil) {
    return mean_conductivity(*soil) == mean_conductivity(*soils.front());
  });
}

bool has_air(const ResultsReader& run, std::size_t index) {
  const auto names = run.field_names(index, "cell");
  if (std::ranges::find(names, "saturation") == names.end()) return false;
  return std::ranges::min(run.field(index, "cell", "saturation").values) < 0.999;
}

/// How much heavier the liquid is than water where it has most fines, relative; 0 without gravity.
double weight_of_fines(const ResultsReader& run, std::size_t index) {
  const Scene& scene = run.scene().scene;
  if (!has_gravity(scene.gravity)) return 0.0;
  double heaviest = 1.0;
  for (const Soil& soil : scene.soils) {
    heaviest = std::max(heaviest, soil.grain_density / scene.liquid.density);
  }
  const auto concentration = run.field(index, "cell", "concentration").values;
  return std::ranges::max(concentration) * (heaviest - 1.0);
}

/// The reasons why some fields of the net are not squares; empty if all are.
std::vector<std::string> imperfections(const ResultsReader& run, std::size_t index,
                                       const std::vector<const Soil*>& soils) {
  std::vector<std::string> lines;
  if (!conduct_alike(soils)) lines.emplace_back("No squares: the soils conduct differently");
  if (has_air(run, index)) lines.emplace_back("No squares where air is in the pores");
  for (const Soil* soil : soils) {
    if (soil->anisotropy() != 1.0) {
      lines.push_back("No right angles in " + soil->region + ", which conducts " +
                      digits_text(1.0 / soil->anisotropy(), 4) +
                      " times as well along its bedding as across");
    }
    if (soil->conductivity_model().depends_on_porosity() && soil->exchanges()) {
      lines.push_back("No squares in " + soil->region + " where fines have moved");
    }
    if (soil->drag == SoilDrag::ergun) {
      lines.push_back("No squares in " + soil->region + ", where drag is not linear");
    }
  }
  const double heavier = weight_of_fines(run, index);
  if (heavier > noticed_weight) {
    lines.push_back("No right angles where fines make the liquid heavier, by " +
                    digits_text(100.0 * heavier, 2) + " % at most");
  }
  return lines;
}

std::vector<std::string> caption_of(const FlowNet& net, double fall) {
  const double q = net.stream.discharge;
  std::vector<std::string> lines;
  lines.push_back("q = " + digits_text(q, 4) + " m3/s per m, N_f = " + std::to_string(net.tubes) +
                  " tubes with " + digits_text(q / net.tubes, 4) + " m3/s per m each");
  lines.push_back("H = " + digits_text(fall, 4) + " m, N_d = " + std::to_string(net.drops) +
                  " drops of " + digits_text(fall / net.drops, 4) + " m");
  if (net.stream.misfit > noticed_net_misfit) {
    lines.push_back("The flow is not steady: streamlines miss " +
                    digits_text(100.0 * net.stream.misfit, 4) +
                    " % of the flux, and H is the highest less the lowest head in the soil");
  }
  return lines;
}

std::vector<double> inner_levels(double low, double step, double high) {
  std::vector<double> levels;
  for (int k = 1; low + (k + 1e-6) * step < high; ++k) levels.push_back(low + k * step);
  return levels;
}

void paint_net(vtkContext2D& painter, const ModelView& view, const FlowNet& net,
               const std::vector<Polyline>& phreatic) {
  const Mesh<2>& mesh = net.map.mesh;
  const auto [lowest, highest] = head_range(net.map);
  const auto heads = inner_levels(lowest, (highest - lowest) / net.drops, highest);
  const auto& psi = net.stream.at_nodes;
  const auto shares = inner_levels(0.0, net.stream.discharge / net.tubes, std::ranges::max(psi));
  paint_outside_water(painter, view, net.map.water);
  paint_edges(painter, view, mesh, region_edges(mesh), boundary_grey, 1.0F);
  std::vector<Polyline> streamlines;
  for (const double share : shares) {
    for (auto& line : level_lines({mesh, psi, shares}, share)) streamlines.push_back(line);
  }
  paint_polylines(painter, view, streamlines, stream_blue, flow_net_width);
  paint_edges(painter, view, mesh, outer_edges(mesh), black, 3.0F);
  LineLabels labels(view);
  labels.avoid(phreatic);
  labels.avoid(streamlines);
  const Mesh<2> drawn = drawn_mesh(net.map);
  paint_contours(painter, view, {drawn, net.map.head, heads}, {black, potential_width}, labels);
  paint_structures(painter, view, mesh, net.map.structures);
  paint_phreatic_lines(painter, view, phreatic);
  view.paint_axes(painter);
}

}  // namespace

SquareNet square_net(double drops_per_tube, const std::optional<int>& tubes) {
  constexpr double fields = 40.0;
  const auto drops_of = [&](int count) {
    return static_cast<int>(std::lround(std::clamp(count * drops_per_tube, 1.0, 1.0 * max_drops)));
  };
  if (tubes) return {*tubes, drops_of(*tubes)};
  const double usual = std::sqrt(fields / drops_per_tube);
  const int least = std::clamp(static_cast<int>(std::lround(0.7 * usual)), 1, max_tubes);
  const int most = std::clamp(static_cast<int>(std::lround(1.5 * usual)), least, max_tubes);
  SquareNet best{least, drops_of(least)};
  double worst = HUGE_VAL;
  for (int count = least; count <= most; ++count) {
    // The second term prefers the usual count among counts whose fields are equally square.
    const double off = std::abs(std::log(drops_of(count) / (count * drops_per_tube))) +
                       0.01 * std::abs(std::log(count / usual));
    if (off >= worst) continue;
    worst = off;
    best = {count, drops_of(count)};
  }
  return best;
}

FlowNet flow_net(const ResultsReader& run, const std::optional<double>& time,
                 const std::optional<int>& tubes) {
  if (tubes && (*tubes < 1 || *tubes > max_tubes)) {
    throw InputError(InputProblem{flow_net_command, "--tubes", std::to_string(*tubes),
                                  "a number from 1 to " + std::to_string(max_tubes)});
  }
  FlowNet net;
  const std::size_t index = chosen_snapshot(run, time, flow_net_command);
  net.map = head_map(run, time, flow_net_command);
  net.map.title = snapshot_title(run, index, time, "Flow net");
  net.stream = stream_function(run, index, net.map.mesh, flow_net_command);
  const auto [lowest, highest] = head_range(net.map);
  const double fall = highest - lowest;
  const auto soils = soils_of(run, net.map.mesh);
  const bool alike = !soils.empty() && conduct_alike(soils);
  const double kh = alike ? mean_conductivity(*soils.front()) * fall : 0.0;
  const SquareNet fields =
      alike ? square_net(kh / net.stream.discharge, tubes) : SquareNet{tubes.value_or(6), 12};
  net.tubes = fields.tubes;
  net.drops = fields.drops;
  net.caption = caption_of(net, fall);
  const auto reasons = imperfections(run, index, soils);
  if (alike && reasons.empty()) {
    net.caption.push_back("Squares: k H N_f / N_d = " + digits_text(kh * net.tubes / net.drops, 4) +
                          " m3/s per m");
  }
  net.caption.insert(net.caption.end(), reasons.begin(), reasons.end());
  return net;
}

void draw_flow_net(const FlowNet& net, const std::string& path) {
  const auto phreatic = phreatic_lines(drawn_mesh(net.map), net.map.pressure);
  std::vector<Curve> rows{legend_line("streamline", stream_blue, flow_net_width),
                          legend_line("equipotential, head in m", black, potential_width)};
  add_structure_legend(rows, net.map.structures);
  add_water_legend(rows, !phreatic.empty(), !net.map.water.empty());
  const float caption_height = legend_row * static_cast<float>(net.caption.size());
  const float legend_height = legend_row * static_cast<float>(rows.size());
  const ModelView view = view_with_water(net.map.mesh, net.map.water,
                                         axes_bottom + caption_height + legend_height + 10.0F);
  float width = view.left() + std::max(view.width(), ChartLegend::width(rows)) + Layout::gap;
  width = std::max(width, Layout::title_width(net.map.title));
  for (const auto& line : net.caption) {
    width = std::max(width, view.left() + 10.0F * static_cast<float>(line.size()) + Layout::gap);
  }
  const auto height = static_cast<int>(view.bottom() + view.height() + room_above_net);
  const auto columns = static_cast<int>(width);
  draw_picture(columns, height, net.map.title, path, [&](vtkContextScene& scene) {
    add_painted(scene, [&](vtkContext2D& painter) {
      paint_net(painter, view, net, phreatic);
      paint_title(painter, net.map.title, columns, height);
      float y = caption_height - 0.5F * legend_row + 6.0F;
      for (const auto& line : net.caption) {
        paint_text(painter, line, 18, view.left(), y, Anchor::left);
        y -= legend_row;
      }
    });
    vtkNew<ChartLegend> legend;
    legend->place(view.left(), caption_height + legend_height + 10.0F, legend_height, rows);
    scene.AddItem(legend);
  });
}

}  // namespace suffuse
