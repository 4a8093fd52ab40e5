#include "instantiation/operator_archive.hpp"

#include <array>
#include <cstring>
#include <optional>
#include <type_traits>
#include <vector>

namespace sunfleck {

namespace {

/// Appends what it is shown.
class Writer {
 public:
  static constexpr bool reads = false;
  template <class T>
  void raw(const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    out.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }
  template <class T>
  void size_of(const std::vector<T>& values) {
    const auto n = static_cast<std::uint64_t>(values.size());
    raw(&n, 1);
  }
  std::string out;
};

/// Fills what it is shown, as long as there are bytes.
class Reader {
 public:
  static constexpr bool reads = true;
  explicit Reader(std::string_view bytes) : in_(bytes) {}
  template <class T>
  void raw(T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > in_.size() / sizeof(T)) good = false;
    if (!good) return;
    std::memcpy(values, in_.data(), count * sizeof(T));
    in_.remove_prefix(count * sizeof(T));
  }
  template <class T>
  void size_of(std::vector<T>& values) {
    std::uint64_t n = 0;
    raw(&n, 1);
    if (n > in_.size()) good = false;  // each takes a byte at least
    values.resize(good ? n : 0);
  }
  bool whole() const { return good && in_.empty(); }
  bool good = true;

 private:
  std::string_view in_;
};

template <class Archive, class T>
void show(Archive& a, T& value) requires std::is_trivially_copyable_v<std::remove_const_t<T>> {
  a.raw(&value, 1);
}

template <class Archive, class T>
void show(Archive& a, std::vector<T>& values) {
  a.size_of(values);
  if constexpr (std::is_trivially_copyable_v<T>)
    a.raw(values.data(), values.size());
  else
    for (auto& v : values) show(a, v);
}

template <class Archive, class Column>
void show(Archive& a, LinkPart<Column>& part) {
  show(a, part.start), show(a, part.column), show(a, part.count);
}

template <class Archive>
void show(Archive& a, LinkRows& rows) {
  show(a, rows.shift), show(a, rows.narrow), show(a, rows.wide);
}

template <class Archive>
void show(Archive& a, Surface& s) {
  show(a, s.origin);
  for (auto& c : s.corner) show(a, c);
  for (auto& n : s.normal) show(a, n);
  show(a, s.first_cell), show(a, s.split), show(a, s.cell_area);
  show(a, s.focus_count), show(a, s.focus), show(a, s.depth_tolerance), show(a, s.ground_gap), show(a, s.periodic);
}

/// Originals have no ground, and have given up what only the making of elements asks for: see original_light().
template <class Archive>
void show(Archive& a, Elements& e) {
  show(a, e.order), show(a, e.plant_facets), show(a, e.surface), show(a, e.element_of_cell), show(a, e.row_of_cell);
  show(a, e.area), show(a, e.material), show(a, e.patch_area), show(a, e.element_area);
}

}  // namespace

/// Knows all members of a LineOperator.
struct OperatorArchive {
  template <class Archive>
  static void show_all(Archive& a, LineOperator& op) {
    show(a, op.inside), show(a, op.outside), show(a, op.lines), show(a, op.enclosed), show(a, op.open_area);
    show(a, op.field_lines), show(a, op.point_start), show(a, op.points), show(a, op.segments), show(a, op.stand_in);
    show(a, op.line_area), show(a, op.fragments);
    show(a, op.directions_), show(a, op.pixels_), show(a, op.seen_), show(a, op.projections_), show(a, op.nearest_);
    show(a, op.seen_sides_), show(a, op.traced_with_), show(a, op.built_with_);
  }
  static std::unique_ptr<LineOperator> empty() { return std::unique_ptr<LineOperator>(new LineOperator); }
};

namespace {

template <class Archive>
void show(Archive& a, OriginalLight& o) {
  show(a, o.elements), show(a, o.interior), show(a, o.facet_material), show(a, o.facet_of_part);
  if constexpr (Archive::reads) o.coarse = OperatorArchive::empty();
  OperatorArchive::show_all(a, *o.coarse);
}

}  // namespace

std::string bytes_of_original(const OriginalLight& original) {
  Writer writer;
  show(writer, const_cast<OriginalLight&>(original));  // writers change nothing
  return std::move(writer.out);
}

std::string bytes_of_operator(const LineOperator& op) {
  Writer writer;
  OperatorArchive::show_all(writer, const_cast<LineOperator&>(op));
  return std::move(writer.out);
}

std::unique_ptr<OriginalLight> original_of_bytes(std::string_view bytes) {
  Reader reader(bytes);
  auto original = std::make_unique<OriginalLight>();
  show(reader, *original);
  return reader.whole() ? std::move(original) : nullptr;
}

std::unique_ptr<LineOperator> operator_of_bytes(std::string_view bytes) {
  Reader reader(bytes);
  auto op = OperatorArchive::empty();
  OperatorArchive::show_all(reader, *op);
  return reader.whole() ? std::move(op) : nullptr;
}

}  // namespace sunfleck
