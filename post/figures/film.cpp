#include "figures/film.hpp"

#include <filesystem>

#include "common/errors.hpp"
#include "common/scratch_folder.hpp"
#include "drawing/png_file.hpp"
#include "figures/film_encoder.hpp"

namespace suffuse {
namespace {

namespace fs = std::filesystem;

/// Copies pictures into a folder, all or none.
void copy_pictures(const std::vector<std::string>& pictures, const std::string& folder) {
  std::vector<fs::path> copies;
  try {
    fs::create_directories(folder);
    for (const fs::path picture : pictures) {
      copies.push_back(fs::path(folder) / picture.filename());
      fs::copy_file(picture, copies.back(), fs::copy_options::overwrite_existing);
    }
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    for (const fs::path& copy : copies) fs::remove(copy, ignored);
    throw FileError(folder + ": " + error.code().message());
  }
}

}  // namespace

void check_film_output(const std::string& output) {
  const std::string suffix = fs::path(output).extension().string();
  if (output.ends_with('/') || suffix == ".mp4" || suffix == ".png") return;
  throw InputError(std::vector{
      InputProblem{"suffuse-post animate", "-o", '"' + output + '"',
                   "a name that ends in .mp4, in .png or, for a folder of pictures, in /", ""}});
}

std::string write_film(const ResultsReader& results, const FilmRequest& request) {
  check_film_output(request.output);
  const ScratchFolder folder("suffuse-post");
  RenderRequest picture = request.picture;
  picture.all = true;
  picture.output = (folder.path() / (picture.field + ".png")).string();
  const std::vector<std::string> pictures = render(results, picture);
  make_equal_size(pictures);
  if (request.output.ends_with('/')) {
    copy_pictures(pictures, request.output);
    return request.output;
  }
  fs::path output = request.output;
  if (output.extension() == ".mp4") {
    const std::string pattern = (folder.path() / (picture.field + "_%04d.png")).string();
    if (encode_mp4(pattern, request.rate, folder.path().string(), output.string()))
      return output.string();
    output.replace_extension(".png");
  }
  write_animated_png(pictures, request.rate, output.string());
  return output.string();
}

}  // namespace suffuse
