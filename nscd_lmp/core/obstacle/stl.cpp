// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/stl.hpp"

#include "base/arguments.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

namespace nscd {

namespace {

constexpr double largest = 1e15;   // m; squares are numbers, as floats too
// A binary file: 80 bytes of any text, the number of triangles, and for each its normal, its corners and 2 bytes.
constexpr std::size_t header = 80, start = header + 4, normal_bytes = 12, record = 50;

template <class Number>
Number number_at(const std::string &bytes, std::size_t place)
{
  static_assert(sizeof(Number) == 4);
  unsigned char raw[4];
  std::memcpy(raw, bytes.data() + place, 4);
  const std::uint32_t little = raw[0] | std::uint32_t(raw[1]) << 8 | std::uint32_t(raw[2]) << 16 |
      std::uint32_t(raw[3]) << 24;
  Number value;
  std::memcpy(&value, &little, 4);
  return value;
}

std::size_t binary_size(const std::string &bytes)
{
  return bytes.size() < start ? start : start + record * number_at<std::uint32_t>(bytes, header);
}

AlignedVector<Triangle> read_binary(const std::string &bytes)
{
  AlignedVector<Triangle> triangles(number_at<std::uint32_t>(bytes, header));
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (int corner = 0; corner < 3; ++corner) {
      Vec4 at{};
      for (int d = 0; d < 3; ++d)
        at[d] = number_at<float>(bytes, start + record * k + normal_bytes + 4 * std::size_t(3 * corner + d));
      triangles[k].corner[corner] = at;
    }
  return triangles;
}

// The words of an ASCII file, in capitals or not.
class Words {
 public:
  Words(const std::string &text, const std::string &file) : text_(text), file_(file) {}

  // The next one in small letters; raises Error at the end of the file.
  std::string next(const char *wanted)
  {
    while (at_ < text_.size() && std::isspace((unsigned char)text_[at_])) line_ += text_[at_++] == '\n';
    if (at_ == text_.size()) fail(file_, " is cut off in line ", line_, ", where '", wanted, "' should be");
    std::string word;
    while (at_ < text_.size() && !std::isspace((unsigned char)text_[at_]))
      word += char(std::tolower((unsigned char)text_[at_++]));
    return word;
  }
  void expect(const char *wanted)
  {
    const std::string word = next(wanted);
    if (word != wanted) fail(file_, ", line ", line_, ": '", word, "' where '", wanted, "' should be");
  }
  double number()
  {
    const std::string word = next("a number");
    double value = 0;
    if (!Arguments::read(word, value)) fail(file_, ", line ", line_, ": '", word, "' is not a number");
    return value;
  }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }
  bool done() const
  {
    return std::all_of(text_.begin() + std::ptrdiff_t(at_), text_.end(),
                       [](unsigned char c) { return std::isspace(c) || c == 0; });
  }

 private:
  const std::string &text_, &file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

Triangle read_facet(Words &words)
{
  words.expect("normal");
  for (int d = 0; d < 3; ++d) words.next("a number");   // some programs write nan
  words.expect("outer");
  words.expect("loop");
  Triangle triangle{};
  for (Vec4 &corner : triangle.corner) {
    words.expect("vertex");
    for (int d = 0; d < 3; ++d) corner[d] = words.number();
  }
  words.expect("endloop");
  words.expect("endfacet");
  return triangle;
}

// One solid or several, one after another.
AlignedVector<Triangle> read_ascii(const std::string &text, const std::string &file)
{
  AlignedVector<Triangle> triangles;
  Words words(text, file);
  do {
    words.expect("solid");
    words.skip_line();
    std::string word;
    while ((word = words.next("endsolid")) == "facet") triangles.push_back(read_facet(words));
    if (word != "endsolid") fail(file, " has '", word, "' where 'facet' or 'endsolid' should be");
    words.skip_line();
  } while (!words.done());
  return triangles;
}

std::string bytes_of(const std::string &path, const std::string &file)
{
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(file, " cannot be opened: give the path of an STL file, as seen from the run's folder");
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad() || bytes.empty()) fail(file, " is empty or cannot be read: give an STL file");
  return bytes;
}

// Binary files may begin with "solid" too, but have the size that they say.
bool is_ascii(const std::string &bytes)
{
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == bytes.npos || bytes.size() == binary_size(bytes)) return false;
  std::string word = bytes.substr(first, 5);
  for (char &c : word) c = char(std::tolower((unsigned char)c));
  return word == "solid";
}

}    // namespace

AlignedVector<Triangle> read_stl(const std::string &path, const std::string &name)
{
  std::string file = name;
  file.append(": file '").append(path).append("'");
  const std::string bytes = bytes_of(path, file);
  const bool ascii = is_ascii(bytes);
  if (!ascii && bytes.size() < binary_size(bytes))
    fail(file, " is no STL file, or is cut off: it has ", bytes.size(), " bytes, does not begin with 'solid', and ",
         "needs ", binary_size(bytes), " as a binary STL file");
  const AlignedVector<Triangle> triangles = ascii ? read_ascii(bytes, file) : read_binary(bytes);
  if (triangles.empty()) fail(file, " has no triangles");
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (const Vec4 &corner : triangles[k].corner)
      if (!(std::abs(corner[0]) + std::abs(corner[1]) + std::abs(corner[2]) <= largest))
        fail(file, ": triangle ", k + 1, " has a corner (", corner[0], ", ", corner[1], ", ", corner[2],
             ") that is not finite or beyond ", largest);
  return triangles;
}

}    // namespace nscd
