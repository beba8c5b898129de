/// Films: one picture per snapshot, all of one size, in files that other programs read.

#include "figures/film.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>

#include "common/errors.hpp"
#include "drawing/png_file.hpp"
#include "post/synthetic_results.hpp"

namespace suffuse {
namespace film_test {

namespace fs = std::filesystem;
using testing::file_text;
using testing::ScratchFolder;

/// What a command prints, or nothing where it fails.
std::optional<std::string> output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen((command + " 2>/dev/null").c_str(), "r"),
                                                   ::pclose);
  std::string text;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe.get()) != nullptr) text += part.data();
  return text.empty() ? std::nullopt : std::optional(text);
}

bool has_ffmpeg() {
  return output_of("ffmpeg -version").has_value() && output_of("ffprobe -version").has_value();
}

/// The PATH of the program while it lives.
class OtherPath {
 public:
  explicit OtherPath(const std::string& path) : before_(std::getenv("PATH")) {
    ::setenv("PATH", path.c_str(), 1);
  }
  OtherPath(const OtherPath&) = delete;
  OtherPath& operator=(const OtherPath&) = delete;
  ~OtherPath() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

/// Three snapshots, at 0, 10 and 40 s.
class Film : public ::testing::Test {
 protected:
  Film() { testing::write_synthetic_results(scratch / "run.results"); }
  [[nodiscard]] std::string write(const std::string& output) const {
    FilmRequest request;
    request.picture.field = "porosity";
    request.rate = 5;
    request.output = scratch / output;
    return write_film(ResultsReader(scratch / "run.results"), request);
  }
  /// Files in the folder in addition to the results.
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(scratch / "")) {
      if (entry.path().filename() != "run.results") names.push_back(entry.path().filename());
    }
    std::ranges::sort(names);
    return names;
  }

  const ScratchFolder scratch;
};

struct Chunk {
  std::string type;
  std::string data;
};

unsigned number_at(const std::string& bytes, std::size_t place) {
  unsigned number = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    number = 256U * number + static_cast<unsigned char>(bytes.at(place + k));
  }
  return number;
}

std::vector<Chunk> chunks_of(const std::string& path) {
  const std::string bytes = file_text(path);
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  std::vector<Chunk> chunks;
  std::size_t place = 8;
  while (place < bytes.size()) {
    const std::size_t size = number_at(bytes, place);
    chunks.push_back({bytes.substr(place + 4, 4), bytes.substr(place + 8, size)});
    place += size + 12;
  }
  EXPECT_EQ(place, bytes.size());
  return chunks;
}

TEST_F(Film, AnimatedPngHasAFrameForEachSnapshot) {
  const std::string path = write("film.png");
  EXPECT_EQ(path, scratch / "film.png");
  const std::vector<Chunk> chunks = chunks_of(path);
  ASSERT_GE(chunks.size(), 3U);
  EXPECT_EQ(chunks[0].type, "IHDR");
  EXPECT_EQ(chunks[1].type, "acTL");
  EXPECT_EQ(number_at(chunks[1].data, 0), 3U);
  EXPECT_EQ(chunks.back().type, "IEND");
  EXPECT_TRUE(file_text(path).ends_with("IEND\xae\x42\x60\x82"));
  unsigned number = 0;
  int frames = 0;
  for (const Chunk& chunk : chunks) {
    if (chunk.type == "fcTL") {
      ++frames;
      EXPECT_EQ(number_at(chunk.data, 0), number++);
      EXPECT_EQ(chunk.data.substr(4, 8), chunks[0].data.substr(0, 8));
      EXPECT_EQ(chunk.data.substr(20, 4), std::string("\0\1\0\5", 4));  // a fifth of a second
    } else if (chunk.type == "fdAT") {
      EXPECT_GT(frames, 1);
      EXPECT_EQ(number_at(chunk.data, 0), number++);
    } else if (chunk.type == "IDAT") {
      EXPECT_EQ(frames, 1);
    }
  }
  EXPECT_EQ(frames, 3);
}

TEST_F(Film, AnimatedPngDecodes) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffprobe is not installed";
  const auto text = output_of(
      "ffprobe -v error -f apng -count_frames -show_entries stream=nb_read_frames -of csv=p=0 " +
      write("film.png"));
  EXPECT_EQ(text, "3\n");
}

TEST_F(Film, Mp4HasAFrameForEachSnapshotAndAnEvenSize) {
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg and ffprobe are not installed";
  const std::string path = write("film.mp4");
  EXPECT_EQ(path, scratch / "film.mp4");
  EXPECT_EQ(files(), std::vector<std::string>{"film.mp4"});
  const auto [width, height] = png_size(write("frames/") + "porosity_0000.png");
  const auto text = output_of(
      "ffprobe -v error -count_frames -show_entries "
      "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 " +
      path);
  EXPECT_EQ(text, "h264," + std::to_string(width + width % 2) + "," +
                      std::to_string(height + height % 2) + ",yuv420p,5/1,3\n");
}

TEST_F(Film, WithoutFfmpegItIsAnAnimatedPng) {
  const OtherPath path(scratch / "nothing");
  EXPECT_EQ(write("film.mp4"), scratch / "film.png");
  EXPECT_EQ(files(), std::vector<std::string>{"film.png"});
}

TEST_F(Film, AFailureOfFfmpegLeavesNothing) {
  const std::string program = scratch / "ffmpeg";
  std::ofstream(program) << "#!/bin/sh\nfor last; do :; done\necho half > \"${last#file:}\"\n"
                            "echo 'no such encoder' >&2\nexit 3\n";
  fs::permissions(program, fs::perms::owner_all);
  const OtherPath path(scratch / "");
  try {
    (void)write("film.mp4");
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), scratch / "film.mp4" +
                                ": ffmpeg failed with exit code 3: no such encoder; -o NAME.png "
                                "needs no ffmpeg");
  }
  EXPECT_EQ(files(), std::vector<std::string>{"ffmpeg"});
}

TEST_F(Film, AFolderGetsThePictures) {
  EXPECT_EQ(write("frames/"), scratch / "frames/");
  const auto first = png_size(scratch / "frames/porosity_0000.png");
  EXPECT_EQ(png_size(scratch / "frames/porosity_0001.png"), first);
  EXPECT_EQ(png_size(scratch / "frames/porosity_0002.png"), first);
  EXPECT_FALSE(fs::exists(scratch / "frames/porosity_0003.png"));
}

TEST_F(Film, OtherNamesAreRefused) {
  EXPECT_THROW((void)write("film.gif"), InputError);
  EXPECT_THROW((void)write("film"), InputError);
}

TEST_F(Film, PicturesBecomeAsLargeAsTheLargest) {
  const std::string small = write("a/") + "porosity_0000.png";
  const auto before = png_size(small);
  // Lines of equal values have a row in the legend, which makes pictures higher.
  testing::write_synthetic_results(scratch / "other.results");
  FilmRequest request;
  request.picture.field = "porosity";
  request.picture.contours = true;
  request.output = scratch / "b/";
  const std::string large =
      write_film(ResultsReader(scratch / "other.results"), request) + "porosity_0000.png";
  ASSERT_GT(png_size(large)[1], before[1]);
  make_equal_size({small, large});
  EXPECT_EQ(png_size(small), png_size(large));
}

}  // namespace film_test
}  // namespace suffuse
