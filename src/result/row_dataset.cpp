#include "result/row_dataset.hpp"

#include <algorithm>
#include <cstring>
#include <new>

#include <tbb/parallel_for.h>
#include <libdeflate.h>

namespace sunfleck::h5 {

namespace {

constexpr std::size_t small_bytes = std::size_t{64} << 10;   // below: stored in one piece, uncompressed
constexpr std::size_t chunk_bytes = std::size_t{256} << 10;  // large enough for deflate, small enough for reading a range
constexpr std::size_t batch_bytes = std::size_t{16} << 20;   // chunks in flight
constexpr int deflate_level = 1;                             // files 1.5 % larger than with zlib at 4, in a third of the time
constexpr std::uint32_t deflate_skipped = 1u << 1;           // filter 0 is shuffle, filter 1 deflate

}  // namespace

Id string_type(std::size_t length) {
  Id type{H5Tcopy(H5T_C_S1)};
  const bool good = type && H5Tset_size(type.get(), std::max<std::size_t>(length, 1)) >= 0 && H5Tset_cset(type.get(), H5T_CSET_UTF8) >= 0 &&
                    H5Tset_strpad(type.get(), H5T_STR_NULLPAD) >= 0;
  if (!good) throw std::bad_alloc();  // nothing else can fail
  return type;
}

namespace {

void write_attribute_raw(OutputFile& file, hid_t object, const char* name, hid_t type, hid_t space, const void* data) {
  const Id attribute{H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT)};
  file.check(attribute && H5Awrite(attribute.get(), type, data) >= 0);
}

}  // namespace

void ChunkQueue::FreeCompressor::operator()(libdeflate_compressor* c) const {
  libdeflate_free_compressor(c);
}

void ChunkQueue::compress(Chunk& chunk) {
  // HDF5's shuffle: all first bytes of the elements, then all second bytes, ...
  const std::size_t count = chunk.bytes.size() / chunk.element_size;
  std::vector<char> shuffled(chunk.bytes.size());
  for (std::size_t byte = 0; byte < chunk.element_size; ++byte)
    for (std::size_t i = 0; i < count; ++i) shuffled[byte * count + i] = chunk.bytes[i * chunk.element_size + byte];

  auto& compressor = compressors_.local();
  if (!compressor) compressor.reset(libdeflate_alloc_compressor(deflate_level));
  if (!compressor) throw std::bad_alloc();
  // 0: it would not fit
  const std::size_t size =
      libdeflate_zlib_compress(compressor.get(), shuffled.data(), shuffled.size(), chunk.bytes.data(), chunk.bytes.size());
  if (size > 0) {
    chunk.bytes.resize(size);
  } else {
    chunk.bytes = std::move(shuffled);
    chunk.skipped_filters = deflate_skipped;
  }
}

void ChunkQueue::add(hid_t dataset, std::span<const hsize_t> offset, std::size_t element_size, std::vector<char> bytes) {
  bytes_ += bytes.size();
  chunks_.push_back({dataset, {offset.begin(), offset.end()}, element_size, std::move(bytes)});
  if (bytes_ >= batch_bytes) flush();
}

void ChunkQueue::flush() {
  tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t i) { compress(chunks_[i]); });
  for (const auto& c : chunks_)
    file_.check(H5Dwrite_chunk(c.dataset, H5P_DEFAULT, c.skipped_filters, c.offset.data(), c.bytes.size(), c.bytes.data()) >= 0);
  chunks_.clear();
  bytes_ = 0;
}

RowDataset::RowDataset(OutputFile& file, ChunkQueue& queue, hid_t parent, const std::string& name, hid_t type, const Shape& shape,
                       std::string_view unit)
    : file_(file), queue_(queue), shape_(shape), type_(type), element_size_(H5Tget_size(type)), row_bytes_(element_size_) {
  std::vector<hsize_t> dims, chunk;
  if (shape.outer > 0) dims.push_back(shape.outer), chunk.push_back(1);
  for (const auto n : shape.inner) row_bytes_ *= n;
  chunk_rows_ = std::clamp<std::size_t>(chunk_bytes / std::max<std::size_t>(row_bytes_, 1), 1, std::max<std::size_t>(shape.rows, 1));
  dims.push_back(shape.rows), chunk.push_back(chunk_rows_);
  for (const auto n : shape.inner) dims.push_back(n), chunk.push_back(n);
  const std::size_t outer = std::max<std::size_t>(shape.outer, 1), total = outer * shape.rows * row_bytes_;
  chunked_ = total > small_bytes;

  const Id properties{H5Pcreate(H5P_DATASET_CREATE)}, space{H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr)};
  bool good = properties && space && element_size_ > 0 && H5Pset_obj_track_times(properties.get(), false) >= 0 &&
              H5Pset_attr_phase_change(properties.get(), 8, 6) >= 0;
  if (good && chunked_)
    good = H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()) >= 0 && H5Pset_shuffle(properties.get()) >= 0 &&
           H5Pset_deflate(properties.get(), deflate_level) >= 0;
  else if (good && total <= 1024)
    good = H5Pset_layout(properties.get(), H5D_COMPACT) >= 0;
  file_.check(good);
  dataset_ = Id{H5Dcreate2(parent, name.c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT)};
  file_.check(static_cast<bool>(dataset_));
  if (!unit.empty()) {
    const Id unit_type = string_type(unit.size()), scalar{H5Screate(H5S_SCALAR)};
    write_attribute_raw(file_, dataset_.get(), "units", unit_type.get(), scalar.get(), unit.data());
  }
  pending_.resize(outer);
  written_rows_.assign(outer, 0);
}

void RowDataset::append(std::size_t outer, const void* rows, std::size_t count) {
  const auto* bytes = static_cast<const char*>(rows);
  auto& pending = pending_[outer];
  const std::size_t full = (chunked_ ? chunk_rows_ : shape_.rows) * row_bytes_;
  for (std::size_t left = count * row_bytes_; left > 0;) {
    if (pending.empty()) pending.reserve(full);
    const std::size_t taken = std::min(left, full - pending.size());
    pending.insert(pending.end(), bytes, bytes + taken);
    bytes += taken;
    left -= taken;
    if (chunked_ && pending.size() == full) write_chunk(outer);
  }
}

void RowDataset::write_chunk(std::size_t outer) {
  auto& pending = pending_[outer];
  std::vector<hsize_t> offset;
  if (shape_.outer > 0) offset.push_back(outer);
  offset.push_back(written_rows_[outer]);
  offset.resize(offset.size() + shape_.inner.size(), 0);
  written_rows_[outer] += pending.size() / row_bytes_;
  pending.resize(chunk_rows_ * row_bytes_, 0);  // the last chunk reaches beyond the end
  queue_.add(dataset_.get(), offset, element_size_, std::move(pending));
  pending = {};
}

void RowDataset::finish() {
  if (chunked_) {
    for (std::size_t o = 0; o < pending_.size(); ++o)
      if (!pending_[o].empty()) write_chunk(o);
    return;
  }
  std::vector<char> all;
  for (auto& p : pending_) all.insert(all.end(), p.begin(), p.end());
  if (!all.empty()) {
    all.resize(pending_.size() * shape_.rows * row_bytes_, 0);
    file_.check(H5Dwrite(dataset_.get(), type_, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) >= 0);
  }
  pending_.assign(pending_.size(), {});
}

void write_attribute(OutputFile& file, hid_t object, const char* name, const std::string& text) {
  // Variable length, so that Python and others read it as text and not as bytes.
  const Id type = string_type(H5T_VARIABLE), space{H5Screate(H5S_SCALAR)};
  const char* pointer = text.c_str();
  write_attribute_raw(file, object, name, type.get(), space.get(), &pointer);
}

void write_attribute(OutputFile& file, hid_t object, const char* name, std::uint64_t value) {
  const Id space{H5Screate(H5S_SCALAR)};
  write_attribute_raw(file, object, name, H5T_NATIVE_UINT64, space.get(), &value);
}

void write_attribute(OutputFile& file, hid_t object, const char* name, const std::vector<double>& values) {
  const hsize_t n = values.size();
  const Id space{H5Screate_simple(1, &n, nullptr)};
  write_attribute_raw(file, object, name, H5T_NATIVE_DOUBLE, space.get(), values.data());
}

Id make_group(OutputFile& file, hid_t parent, const char* name) {
  const Id properties{H5Pcreate(H5P_GROUP_CREATE)};
  file.check(properties && H5Pset_obj_track_times(properties.get(), false) >= 0);
  Id group{H5Gcreate2(parent, name, H5P_DEFAULT, properties.get(), H5P_DEFAULT)};
  file.check(static_cast<bool>(group));
  return group;
}

Id open_or_make_group(OutputFile& file, hid_t parent, const char* name) {
  const htri_t there = H5Lexists(parent, name, H5P_DEFAULT);
  file.check(there >= 0);
  if (there == 0) return make_group(file, parent, name);
  Id group{H5Gopen2(parent, name, H5P_DEFAULT)};
  file.check(static_cast<bool>(group));
  return group;
}

void ArrayWriter::write_raw(hid_t group, const char* name, hid_t type, const void* data, const RowDataset::Shape& shape,
                            std::string_view unit) {
  auto& dataset = open_.emplace_back(file_, queue_, group, name, type, shape, unit);
  std::size_t bytes = H5Tget_size(type) * shape.rows;
  for (const auto n : shape.inner) bytes *= n;
  for (std::size_t o = 0; o < std::max<std::size_t>(shape.outer, 1); ++o)
    dataset.append(o, static_cast<const char*>(data) + o * bytes, shape.rows);
  dataset.finish();
}

void ArrayWriter::write_strings(hid_t group, const char* name, const std::vector<std::string>& texts) {
  std::size_t length = 1;
  for (const auto& t : texts) length = std::max(length, t.size());
  std::vector<char> padded(texts.size() * length, '\0');
  for (std::size_t i = 0; i < texts.size(); ++i)
    std::copy(texts[i].begin(), texts[i].end(), padded.begin() + static_cast<std::ptrdiff_t>(i * length));
  const Id type = string_type(length);
  write_raw(group, name, type.get(), padded.data(), {0, texts.size(), {}}, "");
}

void ArrayWriter::flush() {
  queue_.flush();
  open_.clear();
}

}  // namespace sunfleck::h5
