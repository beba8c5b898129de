#include "results/run_record.hpp"

#include <nlohmann/json.hpp>

#include "common/errors.hpp"
#include "common/regular_file.hpp"
#include "files/layout.hpp"

namespace suffuse {
namespace {

using Json = nlohmann::json;

template <class Value>
void take(const Json& json, const char* key, Value& value) {
  const auto found = json.find(key);
  if (found != json.end() && !found->is_null()) value = found->get<Value>();
}

RunInfo run_info(const Json& json) {
  RunInfo info;
  take(json, "status", info.status);
  take(json, "message", info.message);
  take(json, "steps", info.steps);
  take(json, "solid_points", info.solid_points);
  take(json, "liquid_points", info.liquid_points);
  take(json, "elements", info.elements);
  take(json, "threads", info.threads);
  take(json, "wall_seconds", info.wall_seconds);
  take(json, "memory_bytes", info.memory_bytes);
  take(json, "plan", info.plan);
  take(json, "warnings", info.warnings);
  double resumed_at = -1.0;
  take(json, "resumed_at", resumed_at);
  if (resumed_at >= 0.0) info.resumed_at = resumed_at;
  for (const Json& pass : json.value("passes", Json::array())) {
    PassTiming& timing = info.passes.emplace_back();
    take(pass, "name", timing.name);
    take(pass, "calls", timing.calls);
    take(pass, "seconds", timing.seconds);
  }
  return info;
}

}  // namespace

RunRecord read_run_record(const std::string& folder) {
  const std::string path = layout::in_folder(folder, layout::run_info);
  std::ifstream in = open_regular_file(path);
  const Json json = in.is_open() ? Json::parse(in, nullptr, false) : Json();
  if (!json.is_object()) throw FileError(path + ": cannot be read");
  try {
    RunRecord record;
    record.info = run_info(json);
    take(json, "versions", record.versions);
    take(json, "model", record.model);
    return record;
  } catch (const Json::exception& error) {
    throw FileError(path + ": " + error.what());
  }
}

}  // namespace suffuse
