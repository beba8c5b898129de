#include "figures/render.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include "common/errors.hpp"
#include "drawing/picture.hpp"
#include "figures/axes.hpp"
#include "figures/categories.hpp"
#include "figures/map_water.hpp"
#include "files/number_text.hpp"
#include "values/air.hpp"
#include "values/derived_fields.hpp"
#include "values/fields.hpp"
#include "values/flow_paths.hpp"
#include "values/refusal.hpp"
#include "values/sample.hpp"
#include "values/snapshot_choice.hpp"
#include "values/stream_function.hpp"

namespace suffuse {
namespace {

const std::string render_command = "suffuse-post render";
/// Number of streamlines in a plane picture.
constexpr double tubes = 10.0;
constexpr int paths_in_space = 60;
/// Largest number of elements in SVG and PDF, where each takes 100 to 200 bytes.
constexpr std::ptrdiff_t max_drawn_elements = 20'000;
/// Values that stay in memory when all snapshots are drawn; more are read a second time.
constexpr std::size_t max_kept_values = 20'000'000;
/// Values of this size are round-off, in any unit; those of a flux relative to the conductivity.
constexpr double round_off = 1e-15;
constexpr double flux_round_off = 1e-10;
/// Changes of a field by less than this share of its largest value are round-off.
constexpr double unchanged = 1e-9;

std::vector<std::size_t> wanted_snapshots(const ResultsReader& results,
                                          const RenderRequest& request) {
  const auto& times = results.times();
  if (!request.snapshots.empty()) return request.snapshots;
  if (!request.all) return {chosen_snapshot(results, request.time, render_command)};
  expect_snapshots(results);
  std::vector<std::size_t> every;
  for (std::size_t i = 0; i < times.size(); ++i) every.push_back(i);
  return every;
}

/// A field at several times, read once where memory allows it.
class FieldSeries {
 public:
  FieldSeries(const ResultsReader& results, FieldPlace place)
      : results_(results), place_(std::move(place)) {}

  const ScalarField& at(std::size_t index) {
    const auto found = kept_.find(index);
    if (found != kept_.end()) return found->second;
    ScalarField field = read_scalar(results_, index, place_);
    if (count_ + field.values.size() > max_kept_values) {
      kept_.clear();
      count_ = 0;
    }
    count_ += field.values.size();
    return kept_.emplace(index, std::move(field)).first->second;
  }

 private:
  const ResultsReader& results_;
  FieldPlace place_;
  std::map<std::size_t, ScalarField> kept_;
  std::size_t count_ = 0;
};

bool is_inside(const Vector<2>& x, const std::optional<ViewBox>& box) {
  return !box || ((x.array() >= (*box)[0].array()).all() && (x.array() <= (*box)[1].array()).all());
}

/// Where a field is drawn: on a plane model, or on triangles in a model in space.
struct Canvas {
  PictureModel model;
  std::optional<Mesh<3>> mesh{};
  Sheet sheet{};                  ///< of that mesh
  std::array<int, 2> axes{0, 1};  ///< of the model, along the coordinates of the picture
};

/// Per region: whether it is without soil.
template <int Dim>
std::vector<bool> open_regions(const ResultsReader& results, const Mesh<Dim>& mesh) {
  std::vector<bool> open;
  open.reserve(mesh.region_names.size());
  for (const std::string& region : mesh.region_names) {
    open.push_back(results.scene().scene.find_soil(region) == nullptr);
  }
  return open;
}

/// Throws InputError for options that do not apply to a model of this dimension.
void check_dimension(const ResultsReader& results, const RenderRequest& request) {
  const bool in_space = results.dimension() == 3;
  if (!in_space && request.cut)
    refuse(render_command, "--cut", "a plane model", "it with one in space");
  if (!in_space && !request.levels.empty()) {
    refuse(render_command, "--iso", "a plane model", "--contours, or a model in space");
  }
  if (request.camera && (!in_space || request.cut)) {
    refuse(render_command, "--camera", in_space ? "it with --cut" : "a plane model",
           "it with a model in space that is seen from outside");
  }
  if (!in_space) return;
  if (request.streamlines && request.cut) {
    refuse(render_command, "--streamlines", "it with --cut",
           "--vectors: a cut has no streamlines of its own");
  }
  if (request.on == "solid" || request.on == "liquid") {
    refuse(render_command, "--on", '"' + request.on + "\" of a model in space",
           "\"cell\" or \"node\"; ParaView shows the points");
  }
  if (request.cut && !request.levels.empty())
    refuse(render_command, "--iso", "it with --cut", "one of them");
  if (request.cut) return;
  const std::string option = request.contours  ? "--contours"
                             : request.vectors ? "--vectors"
                             : request.view    ? "--view"
                                               : "";
  if (!option.empty())
    refuse(render_command, option, "it without --cut", "--cut, the plane that shows it");
  if (picture_format(request.output, render_command) != ".png") {
    refuse(render_command, "-o", '"' + request.output + "\" for a model seen from outside",
           "a .png, or --cut");
  }
}

Canvas make_canvas(const ResultsReader& results, const RenderRequest& request) {
  check_dimension(results, request);
  if (results.dimension() == 2) {
    const Mesh<2> mesh = results.mesh();
    Canvas plane{picture_model(mesh, request.view, open_regions(results, mesh))};
    plane.model.structures = structures(mesh, results.scene().scene);
    return plane;
  }
  Canvas canvas;
  canvas.mesh = results.mesh<3>();
  if (!request.cut) {
    canvas.sheet = outer_sheet(*canvas.mesh);
    canvas.model = space_model(*canvas.mesh, canvas.sheet, upward<3>(results.scene().scene),
                               request.camera.value_or(Camera{}));
    return canvas;
  }
  PlaneCut cut = plane_cut(*canvas.mesh, *request.cut, render_command);
  constexpr std::array<const char*, 3> names{"x (m)", "y (m)", "z (m)"};
  canvas.model = picture_model(cut.mesh, request.view, open_regions(results, cut.mesh));
  canvas.model.structures = structures(cut.mesh, results.scene().scene);
  canvas.model.axes = {names.at(cut.axes[0]), names.at(cut.axes[1])};
  canvas.axes = cut.axes;
  canvas.sheet = std::move(cut.sheet);
  return canvas;
}

/// The colour of a surface that faces the viewer or turns away.
Color shaded(const Color& color, const std::array<Vector<3>, 3>& corners) {
  const Vector<3> normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const Vector<3> light(-0.35, 0.55, 0.76);  // right, up, towards the viewer
  const double share = 0.55 + 0.45 * std::abs(normal.dot(light));
  return {share * color[0], share * color[1], share * color[2]};
}

/// Adds the values in view, each with its area.
void add_values(const PictureModel& model, const FieldPicture& picture,
                std::vector<WeightedValue>& values) {
  if (picture.of_points()) {
    for (std::size_t p = 0; p < picture.values.size(); ++p) {
      if (is_inside(picture.positions[p], model.box)) values.push_back({picture.values[p], 1.0});
    }
    return;
  }
  for (int e = 0; e < model.mesh.element_count(); ++e) {
    if (model.visible[e] == 0 || (!picture.air.empty() && picture.air[e])) continue;
    const double area = element_volume(model.mesh, e);
    const auto corners = corner_values(picture, model.mesh, e);
    const bool has_one = picture.where == "cell";
    for (int a = 0; a < (has_one ? 1 : 3); ++a) {
      values.push_back({corners.at(a), has_one ? area : area / 3.0});
    }
  }
}

/// Size of values that are round-off: the flux of a liquid at rest is not exactly zero.
double round_off_of(const ResultsReader& results, const std::string& unit) {
  double largest = 0.0;
  for (const Soil& soil : results.scene().scene.soils) {
    largest = std::max(largest, soil.conductivity);
  }
  return unit == "m/s" ? flux_round_off * largest : round_off;
}

FieldPlace wanted_place(const ResultsReader& results, std::size_t index,
                        const RenderRequest& request) {
  FieldPlace place = find_field(results, index, request.field, request.on, render_command);
  place.change = request.change;
  return place;
}

/// The pictures of one request: what they share, and how each is made.
class Frames {
 public:
  Frames(const ResultsReader& results, const RenderRequest& request)
      : results_(results),
        request_(request),
        canvas_(make_canvas(results, request)),
        model_(canvas_.model),
        snapshots_(wanted_snapshots(results, request)),
        place_(wanted_place(results, snapshots_.front(), request)),
        series_(results, place_),
        title_(field_title(place_)) {}

  std::vector<std::string> draw();

 private:
  void refuse_what_cannot_be_drawn() const;
  /// The colours, for the values of all snapshots.
  [[nodiscard]] FieldScale scale();
  /// The elements of the model of which a snapshot shows nothing; or none.
  [[nodiscard]] std::vector<bool> air(std::size_t index) const;
  /// The picture of a snapshot without lines and arrows.
  [[nodiscard]] FieldPicture picture(std::size_t index);
  void add_flow(FieldPicture& picture, std::size_t index) const;
  /// Adds what is seen within the edges of a model in space.
  void add_inside(FieldPicture& picture, std::size_t index);
  /// Adds surfaces of equal values.
  void add_levels(FieldPicture& picture, const std::vector<double>& at_nodes) const;
  /// Adds streamlines in the colours of the field.
  void add_paths(FieldPicture& picture, const std::vector<double>& at_nodes,
                 std::size_t index) const;

  const ResultsReader& results_;
  const RenderRequest& request_;
  Canvas canvas_;
  const PictureModel& model_;
  std::vector<std::size_t> snapshots_;
  FieldPlace place_;
  FieldSeries series_;
  std::string title_;  ///< of all pictures, before the time
};

void Frames::refuse_what_cannot_be_drawn() const {
  if (model_.visible_count == 0) {
    refuse(render_command, "--view", "a part with nothing of the model in it",
           "x0,y0:x1,y1 in metres, with some");
  }
  const bool drawn = picture_format(request_.output, render_command) != ".png";
  if (drawn && model_.visible_count > max_drawn_elements) {
    refuse(render_command, "-o",
           '"' + request_.output + "\" for " + std::to_string(model_.visible_count) + " elements",
           "a .png, or at most " + std::to_string(max_drawn_elements) +
               " elements: --view shows a part");
  }
  const bool has_kinds = !categories(results_, place_).empty();
  const std::string option = request_.contours      ? "--contours"
                             : request_.logarithmic ? "--log"
                             : request_.change      ? "--change"
                                                    : "";
  if (has_kinds && !option.empty()) {
    refuse(render_command, option, "a field of kinds, \"" + place_.name + '"',
           "a field of numbers");
  }
  if (request_.contours && (place_.where == "solid" || place_.where == "liquid")) {
    refuse(render_command, "--contours",
           "a field of points, \"" + place_.name + "\" on " + place_.where,
           "a field on cell or node");
  }
  if (request_.logarithmic && request_.range && !((*request_.range)[0] > 0.0)) {
    refuse(render_command, "--range", number_text((*request_.range)[0]) + " with --log",
           "a range above zero");
  }
}

FieldScale Frames::scale() {
  FieldScale kinds;
  kinds.kinds = categories(results_, place_);
  if (!kinds.kinds.empty()) return kinds;
  std::vector<WeightedValue> values;
  for (const std::size_t index : snapshots_) {
    if (request_.levels.empty() && !(canvas_.mesh && request_.streamlines)) {
      add_values(model_, picture(index), values);
    } else {
      for (const double value : series_.at(index).values) values.push_back({value, 1.0});
    }
  }
  double zero = round_off_of(results_, series_.at(snapshots_.front()).unit);
  if (place_.change) {
    const FieldPlace itself{place_.name, place_.where};
    for (const double value : read_scalar(results_, 0, itself).values) {
      if (std::isfinite(value)) zero = std::max(zero, unchanged * std::abs(value));
    }
  }
  const auto is_positive = [&](const WeightedValue& v) { return v.value > zero; };
  if (request_.logarithmic && std::ranges::none_of(values, is_positive)) {
    refuse(render_command, "--log", '"' + place_.name + "\" without a value above zero",
           "a field with some");
  }
  const bool of_points = place_.where == "solid" || place_.where == "liquid";
  return value_scale(std::move(values),
                     {request_.range, request_.logarithmic, zero, of_points ? "points" : "area"});
}

std::vector<bool> Frames::air(std::size_t index) const {
  if (!canvas_.mesh) return elements_of_air(results_, index, model_.mesh);
  std::vector<bool> drawn;
  if (model_.space) return drawn;  // the surface has no holes
  const std::vector<bool> air = elements_of_air(results_, index, *canvas_.mesh);
  drawn.reserve(canvas_.sheet.element.size());
  for (const int e : canvas_.sheet.element) drawn.push_back(!air.empty() && air[e]);
  return drawn;
}

FieldPicture Frames::picture(std::size_t index) {
  const ScalarField& field = series_.at(index);
  FieldPicture picture;
  picture.title = snapshot_title(results_, index, request_.time, title_);
  picture.label =
      categories(results_, place_).empty() ? field_label(place_, field) : field_title(place_);
  picture.where = place_.where;
  picture.values = canvas_.mesh
                       ? sheet_values(*canvas_.mesh, canvas_.sheet, place_.where, field.values)
                       : field.values;
  if (request_.contours) picture.line_values = own_node_values(results_, index, place_);
  if (canvas_.mesh && !picture.line_values.empty()) {
    picture.line_values = sheet_values(*canvas_.mesh, canvas_.sheet, "node", picture.line_values);
  }
  if (request_.cut) picture.title += ", " + cut_text(*request_.cut);
  picture.air = air(index);
  if (!picture.of_points()) return picture;
  picture.positions = results_.point_positions(index, place_.where);
  const auto names = results_.field_names(index, place_.where);
  if (std::ranges::find(names, "volume") != names.end()) {
    picture.volumes = results_.field(index, place_.where, "volume").values;
  }
  return picture;
}

void Frames::add_flow(FieldPicture& picture, std::size_t index) const {
  if ((!request_.vectors && !request_.streamlines) || !flows(results_, index)) return;
  if (request_.vectors) {
    const Field flux = results_.field(index, "cell", "darcy_flux");
    for (int e = 0; e < model_.mesh.element_count(); ++e) {
      const int element = canvas_.mesh ? canvas_.sheet.element[e] : e;
      for (const int axis : canvas_.axes) {
        picture.arrows.push_back(flux.values[flux.components * element + axis]);
      }
    }
  }
  if (!request_.streamlines || canvas_.mesh) return;
  StreamFunction stream = stream_function(results_, index, model_.mesh, render_command);
  picture.streamfunction = std::move(stream.at_nodes);
  picture.tube = stream.discharge / tubes;
  picture.misfit = stream.misfit;
}

void Frames::add_inside(FieldPicture& picture, std::size_t index) {
  picture.hollow = canvas_.mesh && (!request_.levels.empty() || request_.streamlines);
  if (!picture.hollow) return;
  std::vector<double> at_nodes = own_node_values(results_, index, place_);
  if (at_nodes.empty()) {
    at_nodes = node_means(*canvas_.mesh, place_.where, series_.at(index).values);
  }
  add_levels(picture, at_nodes);
  if (request_.streamlines && flows(results_, index)) add_paths(picture, at_nodes, index);
}

void Frames::add_levels(FieldPicture& picture, const std::vector<double>& at_nodes) const {
  const Mesh<3>& mesh = *canvas_.mesh;
  for (const double level : request_.levels) {
    const Sheet sheet = level_sheet(mesh, at_nodes, level);
    for (const auto& triangle : sheet.triangles) {
      SpaceTriangle drawn;
      for (int a = 0; a < 3; ++a) {
        const Vector<3> x = position(mesh, sheet.nodes[triangle.at(a)]);
        drawn.corners.at(a) = model_.space->view.project(x);
      }
      drawn.color = shaded(picture.scale.color(level), drawn.corners);
      picture.inside.push_back(drawn);
    }
  }
}

void Frames::add_paths(FieldPicture& picture, const std::vector<double>& at_nodes,
                       std::size_t index) const {
  const Mesh<3>& mesh = *canvas_.mesh;
  const Field flux = results_.field(index, "cell", "darcy_flux");
  const FlowPaths flow = flow_paths(mesh, flux.values, paths_in_space);
  picture.tube = flow.discharge / paths_in_space;
  const SpaceView& view = model_.space->view;
  for (const FlowPath& path : flow.paths) {
    for (std::size_t k = 0; k < path.elements.size(); ++k) {
      double mean = 0.0;
      for (const int node : mesh.elements[path.elements[k]]) mean += at_nodes[node] / 4.0;
      picture.paths.push_back({{view.project(path.places[k]), view.project(path.places[k + 1])},
                               picture.scale.color(mean)});
    }
  }
}

/// `FILE_0007.png` for `FILE.png` and 7.
std::string numbered(const std::string& path, std::size_t number) {
  char digits[24];
  std::snprintf(digits, sizeof digits, "_%04zu", number);
  const std::filesystem::path file(path);
  return (file.parent_path() / (file.stem().string() + digits + file.extension().string()))
      .string();
}

std::vector<std::string> Frames::draw() {
  refuse_what_cannot_be_drawn();
  const FieldScale colors = scale();
  const bool same = place_.change && colors.uniform && colors.range[1] == 0.0;
  if (same) title_ = field_title({place_.name, place_.where}) + " has not changed since the start";
  std::vector<std::vector<OutsideWater>> waters;
  std::vector<OutsideWater> room;
  for (const std::size_t index : snapshots_) {
    waters.push_back(model_.space ? std::vector<OutsideWater>{}
                                  : water_outside(results_, index, model_.mesh, canvas_.axes));
    room.insert(room.end(), waters.back().begin(), waters.back().end());
  }
  const bool several = request_.all || !request_.snapshots.empty();
  std::vector<std::string> written;
  for (std::size_t k = 0; k < snapshots_.size(); ++k) {
    const std::size_t index = snapshots_[k];
    FieldPicture frame = picture(index);
    frame.scale = colors;
    frame.contours = request_.contours;
    frame.mesh_edges = request_.mesh;
    frame.water = waters[k];
    frame.room = room;
    add_flow(frame, index);
    add_inside(frame, index);
    written.push_back(several ? numbered(request_.output, index) : request_.output);
    draw_field_picture(model_, frame, written.back());
  }
  return written;
}

}  // namespace

std::array<double, 2> parse_range(const std::string& text) {
  return parse_range(text, render_command, "--range");
}

ViewBox parse_view(const std::string& text) {
  const SampleLine corners = parse_line(text, render_command, "--view");
  const bool plane = corners.from.size() == 2;
  if (plane && (corners.from.array() < corners.to.array()).all()) {
    return {Vector<2>(corners.from), Vector<2>(corners.to)};
  }
  refuse(render_command, "--view", '"' + text + '"',
         "x0,y0:x1,y1 with x0 below x1 and y0 below y1");
}

Camera parse_camera(const std::string& text) {
  const auto comma = text.find(',');
  if (comma != std::string::npos) {
    const auto azimuth = parse_number(text.substr(0, comma));
    const auto elevation = parse_number(text.substr(comma + 1));
    if (azimuth && elevation && std::abs(*azimuth) <= 360.0 && *elevation >= 0.0 &&
        *elevation <= 80.0) {
      return {*azimuth, *elevation};
    }
  }
  refuse(render_command, "--camera", '"' + text + '"',
         "AZIMUTH,ELEVATION in degrees, from -360 to 360 and from 0 to 80");
}

std::vector<double> parse_levels(const std::string& text) {
  std::vector<double> levels;
  for (const std::string& part : parse_field_names(text)) {
    const auto level = parse_number(part);
    if (!level || !std::isfinite(*level)) {
      refuse(render_command, "--iso", '"' + text + '"', "numbers with commas between");
    }
    levels.push_back(*level);
  }
  return levels;
}

std::vector<std::string> render(const ResultsReader& results, const RenderRequest& request) {
  picture_format(request.output, render_command);
  return Frames(results, request).draw();
}

}  // namespace suffuse
