// PLY (Turk 1994): a header says which properties follow, in what types and order.
#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "sardf/mesh_read_formats.hpp"

namespace sardf {

namespace {

struct Type {
  const char *name, *other_name;
  size_t size;
  char form;  // i: signed, u: unsigned, f: floating
};
constexpr Type types[] = {{"char", "int8", 1, 'i'},     {"uchar", "uint8", 1, 'u'},
                          {"short", "int16", 2, 'i'},   {"ushort", "uint16", 2, 'u'},
                          {"int", "int32", 4, 'i'},     {"uint", "uint32", 4, 'u'},
                          {"float", "float32", 4, 'f'}, {"double", "float64", 8, 'f'}};

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* count = nullptr;  // of a list: its length's type
};

struct Element {
  std::string name;
  uint64_t count = 0, line = 0;
  std::vector<Property> properties;
};

enum class Coding { text, little, big };

struct Header {
  Coding coding = Coding::text;
  std::vector<Element> elements;
  size_t end = 0;     // its size in bytes
  uint64_t line = 0;  // the first one after it
};

class HeaderReader {
 public:
  explicit HeaderReader(const MeshBytes& file) : words_(file.bytes), path_(file.path) {}

  Header read() {
    if (words_.word() != "ply") fail("a PLY file begins with a line 'ply'");
    bool has_format = false;
    for (;;) {
      if (!words_.next_line()) fail("the file ends before end_header");
      const std::string_view keyword = words_.word();
      if (keyword == "end_header") break;
      if (keyword == "format") {
        format();
        has_format = true;
      } else if (keyword == "element") {
        element();
      } else if (keyword == "property") {
        property();
      } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
        fail("found '" + std::string(keyword) +
             "'; format, element, property, comment, obj_info and end_header are accepted");
      }
    }
    if (!has_format) fail("the header has no format line");
    words_.next_line();
    header_.end = words_.position();
    header_.line = words_.line();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(message, path_, int(words_.line()));
  }

  void format() {
    const std::string_view coding = words_.word();
    if (coding == "ascii") {
      header_.coding = Coding::text;
    } else if (coding == "binary_little_endian") {
      header_.coding = Coding::little;
    } else if (coding == "binary_big_endian") {
      header_.coding = Coding::big;
    } else {
      fail("the format is '" + std::string(coding) +
           "'; ascii, binary_little_endian and binary_big_endian are accepted");
    }
  }

  void element() {
    Element made;
    made.line = words_.line();
    made.name = words_.word();
    const std::string_view count = words_.word();
    int64_t number = -1;
    if (!parse_number(count, number) || number < 0) {
      fail("element " + made.name + " has the count '" + std::string(count) +
           "'; a whole number from 0 is accepted");
    }
    made.count = uint64_t(number);
    header_.elements.push_back(made);
  }

  const Type* type() {
    const std::string_view name = words_.word();
    for (const Type& t : types) {
      if (name == t.name || name == t.other_name) return &t;
    }
    std::vector<std::string> names;
    for (const Type& t : types) names.insert(names.end(), {t.name, t.other_name});
    fail("there is no type '" + std::string(name) + "'" + did_you_mean(std::string(name), names));
  }

  void property() {
    if (header_.elements.empty()) fail("a property comes before any element");
    MeshWords ahead = words_;
    Property made;
    if (ahead.word() == "list") {
      words_.word();
      made.count = type();
      if (made.count->form == 'f') fail("the length of a list is a whole number");
    }
    made.type = type();
    made.name = words_.word();
    header_.elements.back().properties.push_back(made);
  }

  MeshWords words_;
  std::string path_;
  Header header_;
};

/// The numbers after the header, in text or binary.
class Numbers {
 public:
  Numbers(const MeshBytes& file, const Header& header)
      : coding_(header.coding),
        bytes_(std::string_view(file.bytes).substr(header.end)),
        words_(bytes_, header.line),
        start_(header.end) {}

  bool in_lines() const { return coding_ == Coding::text; }
  /// The line, or the byte, of what comes next.
  uint64_t place() {
    if (!in_lines()) return start_ + at_;
    words_.skip_to_word();
    return words_.line();
  }
  /// Bytes of the file that are read.
  size_t position() const { return start_ + (in_lines() ? words_.position() : at_); }
  size_t left() const { return start_ + bytes_.size() - position(); }

  /// The next number; nullopt at the end of the file or where there is none.
  std::optional<double> next(const Type& type) {
    if (in_lines()) {
      double number = 0;
      if (!parse_number(words_.word_of_any_line(), number)) return std::nullopt;
      return number;
    }
    if (type.size > bytes_.size() - at_) return std::nullopt;
    uint64_t word = 0;
    for (size_t i = 0; i < type.size; ++i) {
      const size_t from = coding_ == Coding::big ? i : type.size - 1 - i;
      word = word << 8 | uint8_t(bytes_[at_ + from]);
    }
    at_ += type.size;
    return decoded(type, word);
  }

 private:
  static double decoded(const Type& type, uint64_t word) {
    if (type.form == 'u') return double(word);
    if (type.form == 'f') {
      return type.size == 4 ? double(std::bit_cast<float>(uint32_t(word)))
                            : std::bit_cast<double>(word);
    }
    const int unused = int(64 - 8 * type.size);
    return double(int64_t(word << unused) >> unused);
  }

  Coding coding_;
  std::string_view bytes_;
  MeshWords words_;
  size_t start_, at_ = 0;
};

/// The polygons from the numbers that the header announces.
class BodyReader {
 public:
  BodyReader(const MeshBytes& file, const Header& header)
      : numbers_(file, header), mesh_(file, numbers_.in_lines()), path_(file.path) {}

  PolygonMesh read(const Header& header) {
    for (const Element& element : header.elements) {
      check_size(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else {
        read_faces(element);
      }
    }
    return std::move(mesh_);
  }

 private:
  // Before anything is made for the elements that a short file cannot hold.
  void check_size(const Element& element) {
    size_t least = 0;
    for (const Property& p : element.properties) {
      least += numbers_.in_lines() ? 2 : p.count ? p.count->size : p.type->size;
    }
    if (least == 0 || element.count <= (numbers_.left() + numbers_.in_lines()) / least) return;
    throw Error("the file is too short for the " + std::to_string(element.count) + " elements '" +
                    element.name + "' that it announces",
                path_, int(element.line));
  }

  double number(const Type& type, const Element& element, uint64_t index) {
    const uint64_t place = numbers_.place();
    const std::optional<double> found = numbers_.next(type);
    mesh_.step(numbers_.position());
    if (!found) {
      mesh_.fail("found the end of the file, or what is no number, in element " +
                     std::to_string(index) + ", counted from 0, of the " +
                     std::to_string(element.count) + " '" + element.name + "'",
                 numbers_.in_lines() ? numbers_.place() : place);
    }
    return *found;
  }

  // A whole number; -1 for any other.
  static int64_t whole(double a) {
    return a >= 0 && a < 0x1p53 && a == double(int64_t(a)) ? int64_t(a) : -1;
  }

  uint64_t length(const Property& list, const Element& element, uint64_t index) {
    const uint64_t place = numbers_.place();
    const int64_t count = whole(number(*list.count, element, index));
    if (count < 0) mesh_.fail("the length of list '" + list.name + "' is no whole number", place);
    return uint64_t(count);
  }

  void skip(const Property& p, const Element& element, uint64_t index) {
    const uint64_t values = p.count ? length(p, element, index) : 1;
    for (uint64_t i = 0; i < values; ++i) number(*p.type, element, index);
  }

  void read_vertices(const Element& element) {
    const auto is_axis = [](const Property& p) {
      return !p.count && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z';
    };
    std::string axes;
    for (const Property& p : element.properties) {
      if (is_axis(p)) axes += p.name;
    }
    std::sort(axes.begin(), axes.end());
    if (axes != "xyz") {
      throw Error("the element vertex does not have one property each of x, y and z", path_,
                  int(element.line));
    }
    for (uint64_t i = 0; i < element.count; ++i) {
      const uint64_t place = numbers_.place();
      Vec3 at{};
      for (const Property& p : element.properties) {
        if (is_axis(p)) {
          at[size_t(p.name[0] - 'x')] = number(*p.type, element, i);
        } else {
          skip(p, element, i);
        }
      }
      mesh_.add_vertex(at, place);
    }
  }

  void read_faces(const Element& element) {
    for (uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
      for (const Property& p : element.properties) {
        const bool corners = element.name == "face" && p.count &&
                             (p.name == "vertex_indices" || p.name == "vertex_index");
        if (!corners) {
          skip(p, element, i);
          continue;
        }
        const uint64_t place = numbers_.place(), count = length(p, element, i);
        for (uint64_t k = 0; k < count; ++k) {
          mesh_.add_corner(whole(number(*p.type, element, i)));
        }
        mesh_.end_polygon(place);
      }
    }
  }

  Numbers numbers_;
  PolygonMesh mesh_;
  std::string path_;
};

}  // namespace

PolygonMesh read_ply(const MeshBytes& file) {
  const Header header = HeaderReader(file).read();
  return BodyReader(file, header).read(header);
}

}  // namespace sardf
