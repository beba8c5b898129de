#include "common/chunk_writer.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <vector>

namespace suffuse {
namespace {

// The bytes of numbers are written as in memory.
static_assert(std::endian::native == std::endian::little);

/// Effort of compression: zlib's level and strategy.
struct Effort {
  int level = 1;
  int strategy = Z_DEFAULT_STRATEGY;
  bool operator==(const Effort&) const = default;
};

/// The effort for some bytes, from a sample of a thousand. Bytes without frequent values and with
/// few equal neighbours, such as the low digits of computed numbers, are not compressed. If at most
/// a quarter of other bytes have equal neighbours, only runs of one value are searched for.
Effort effort_for(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t samples = 1024;
  std::array<std::uint64_t, 256> counts{};
  std::uint64_t seen = 0;
  std::uint64_t repeated = 0;
  const std::size_t stride = std::max<std::size_t>(1, bytes.size() / samples);
  for (std::size_t i = 1; i < bytes.size(); i += stride) {
    ++counts[bytes[i]];
    ++seen;
    if (bytes[i] == bytes[i - 1]) ++repeated;
  }
  // Ordered pairs of equal bytes: 1/256 of all pairs when all values are equally frequent.
  std::uint64_t pairs = 0;
  for (const std::uint64_t count : counts) pairs += count > 0 ? count * (count - 1) : 0;
  if (64 * pairs < seen * seen && 16 * repeated < seen) return {Z_NO_COMPRESSION};
  if (4 * repeated <= seen) return {1, Z_RLE};
  return {};
}

/// Compresses one chunk after the other. Restarting zlib for each would take as long as compressing
/// a small chunk.
class Compressor {
 public:
  Compressor() { works_ = deflateInit(&stream_, effort_.level) == Z_OK; }
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
  ~Compressor() {
    if (works_) deflateEnd(&stream_);
  }

  /// Compresses numbers whose bytes are sorted: all first bytes, then all second bytes, and so on.
  /// The result is valid until the next call, and empty if zlib fails.
  std::span<const std::uint8_t> compress(std::span<const std::uint8_t> sorted,
                                         std::size_t number_size) {
    if (!works_ || deflateReset(&stream_) != Z_OK) return {};
    // Room for the headers of the stored blocks and for the ends of the blocks around them.
    out_.resize(deflateBound(&stream_, sorted.size()) + sorted.size() / 1024 + 64 * number_size);
    stream_.next_out = out_.data();
    stream_.avail_out = static_cast<uInt>(out_.size());
    stream_.avail_in = 0;
    const std::size_t count = sorted.size() / number_size;
    for (std::size_t k = 0; k < number_size; ++k) {
      const auto bytes = sorted.subspan(k * count, count);
      set_effort(effort_for(bytes));
      // zlib does not change its input.
      stream_.next_in = const_cast<std::uint8_t*>(bytes.data());
      stream_.avail_in = static_cast<uInt>(count);
      const bool last = k + 1 == number_size;
      const int status = deflate(&stream_, last ? Z_FINISH : Z_NO_FLUSH);
      if (status != (last ? Z_STREAM_END : Z_OK) || stream_.avail_in > 0) return {};
    }
    return {out_.data(), stream_.total_out};
  }

 private:
  void set_effort(const Effort& effort) {
    if (effort == effort_) return;
    deflateParams(&stream_, effort.level, effort.strategy);
    effort_ = effort;
  }

  z_stream stream_{};
  Effort effort_;
  bool works_ = false;
  std::vector<std::uint8_t> out_;
};

/// Column `column` from row `first` on, with its bytes sorted; zeros after the last row.
void sort_bytes(const ChunkShape& shape, const std::uint8_t* numbers, std::size_t first,
                std::size_t column, std::vector<std::uint8_t>& sorted) {
  const std::size_t size = shape.number_size;
  const std::size_t count = std::min(shape.chunk_rows, shape.rows - first);
  if (count < shape.chunk_rows) std::ranges::fill(sorted, std::uint8_t{0});
  const std::uint8_t* from = numbers + (first * shape.columns + column) * size;
  for (std::size_t k = 0; k < size; ++k) {
    std::uint8_t* to = sorted.data() + k * shape.chunk_rows;
    const std::size_t stride = shape.columns * size;
    for (std::size_t i = 0; i < count; ++i) to[i] = from[i * stride + k];
  }
}

}  // namespace

ChunkShape chunk_shape(std::size_t rows, std::size_t columns, std::size_t number_size) {
  constexpr std::size_t most = std::size_t{1} << 19;
  return {rows, columns, std::min(rows, most), number_size};
}

bool write_chunks(hid_t set, const ChunkShape& shape, const std::uint8_t* numbers) {
  thread_local Compressor compressor;
  std::vector<std::uint8_t> sorted(shape.chunk_rows * shape.number_size);
  for (std::size_t first = 0; first < shape.rows; first += shape.chunk_rows) {
    for (std::size_t column = 0; column < shape.columns; ++column) {
      sort_bytes(shape, numbers, first, column, sorted);
      const auto bytes = compressor.compress(sorted, shape.number_size);
      if (bytes.empty()) return false;
      const std::array<hsize_t, 2> offset{first, column};
      if (H5Dwrite_chunk(set, H5P_DEFAULT, 0, offset.data(), bytes.size(), bytes.data()) < 0) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace suffuse
