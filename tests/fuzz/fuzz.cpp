/// All targets in one program: `fuzz --target=NAME`, then libFuzzer's own options and folders.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "mutator.hpp"
#include "targets.hpp"
#include "vocabulary.hpp"

// libFuzzer's interface: its names, its types.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using namespace suffuse::fuzz;

struct Target {
  std::string name;
  void (*run)(const std::string&) = nullptr;
  Vocabulary words;
  std::string (*new_line)(const Vocabulary&, const Draw&) = nullptr;
};

Target target;

Target find_target(const std::string& name) {
  if (name == "scene") {
    Vocabulary words;
    words.settings = scene_settings();
    return {name, try_scene, words, drawn_scene_line};
  }
  if (name == "geometry") {
    Vocabulary words;
    words.settings = geometry_lines();
    return {name, try_geometry, words, drawn_geometry_line};
  }
  if (name == "case") return {name, try_case, case_vocabulary(), drawn_edit};
  if (name == "results") return {name, try_results, results_vocabulary(), drawn_edit};
#ifndef SUFFUSE_FUZZ_READERS
  if (name == "model") return {name, try_model, case_vocabulary(), drawn_edit};
#endif
  std::fprintf(stderr,
               "fuzz: got '%s'; expected --target=scene, geometry, case, results or model\n",
               name.c_str());
  std::exit(2);
}

std::size_t give(const std::string& text, std::uint8_t* data, std::size_t most) {
  const std::size_t size = std::min(text.size(), most);
  std::memcpy(data, text.data(), size);
  return size;
}

Draw draw_from(std::minstd_rand& random) {
  return [&random](std::size_t count) { return static_cast<std::size_t>(random()) % count; };
}

std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const std::string option = "--target=";
  for (int i = 1; i < *argc; ++i) {
    const std::string argument = (*argv)[i];
    if (argument.starts_with(option)) target = find_target(argument.substr(option.size()));
  }
  if (target.run == nullptr) target = find_target("");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target.run(text_of(data, size));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  std::minstd_rand random(seed);
  const Draw draw = draw_from(random);
  const bool is_binary = size > 0 && data[0] == 0x89;
  if (is_binary || draw(6) == 0) return LLVMFuzzerMutate(data, size, most);
  const std::string text =
      changed(text_of(data, size), draw, [&] { return target.new_line(target.words, draw); });
  return give(text, data, most);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* a, std::size_t size_of_a,
                                                 const std::uint8_t* b, std::size_t size_of_b,
                                                 std::uint8_t* out, std::size_t most,
                                                 unsigned seed) {
  std::minstd_rand random(seed);
  const Draw draw = draw_from(random);
  return give(crossed(text_of(a, size_of_a), text_of(b, size_of_b), draw), out, most);
}
// NOLINTEND(readability-identifier-naming)
