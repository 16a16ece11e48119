// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_VOX_HPP
#define PULSECAST_IO_VOX_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/format_rules.hpp>
#include <pulsecast/shape/voxel_data.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Use of the voxels of a file.
enum class VoxelUse : std::uint8_t {
  transmissive,  ///< filled with leaves of a density
  opaque,        ///< cubes of the size of their cells
  scaled,        ///< cubes that shrink with the density of their cells
};

/// Settings for voxel files.
struct VoxelFileSettings {
  VoxelUse use = VoxelUse::transmissive;  ///< use of the voxels
  double exponent = 0.5;                  ///< edges of scaled cubes: (PAD / PADmax)^exponent
  std::optional<double> density_max{};    ///< PADmax; default: by the file [m^2/m^3]
  std::optional<std::uint64_t> shift{};   ///< seed of shifts of scaled cubes; or none

  void validate() const {
    require_not_negative("VoxelFileSettings::exponent", exponent, "");
    if (density_max) require_positive("VoxelFileSettings::density_max", *density_max, "m^2/m^3");
  }
};

/// Content of a voxel file.
struct VoxelFile {
  VoxelData voxels;                   ///< with densities, or with scales and shifts, by use
  std::vector<float> transmittances;  ///< for each voxel, NaN where unknown; or empty
  double density_max = 0;             ///< PADmax: as set, from the file, or its maximum [m^2/m^3]
  std::vector<std::string> warnings;  ///< oddities that could still be read
};

/// Reads a voxel file of AMAPVox: text that begins with `VOXEL SPACE`. Lines of `#key: value`
/// follow in any order, then a row of column names, and a row for each voxel. Required keys are
/// `min_corner` and `res` (one edge length, as voxels are cubes); required columns i, j, k and
/// PadBVTotal, for opaque and scaled voxels also transmittance. Left out of the grid are
/// - transmissive voxels of density 0, or, with a warning, NaN;
/// - opaque and scaled voxels of transmittance 1 (fully transparent) or NaN (never observed);
/// - scaled voxels of density 0, and so of size 0, or, with a warning, NaN.
/// Shifts of scaled cubes are uniform within their cells, and depend on the seed and the cell
/// alone. Throws a `FileError` with path and line at the first error, and if no voxel is left.
/// Source: AMAPVox (Vincent et al. 2017); Weiser et al. 2021, opaque voxel-based tree models.
[[nodiscard]] VoxelFile read_voxel_file(const std::filesystem::path& path, const VoxelFileSettings& settings = {});

namespace detail {

/// Keys and columns of voxel files. Source: AMAPVox (Vincent et al. 2017).
inline constexpr auto vox_rules = std::to_array<FormatRule>({
    {"min_corner", FormatUse::read, "lowest corner of the grid"},
    {"max_corner", FormatUse::read, "compared with the lowest corner, split and res"},
    {"split", FormatUse::read, "number of voxels along each axis, which indices are below"},
    {"res", FormatUse::read, "edge of the voxels, which are cubes"},
    {"max_pad", FormatUse::read, "density of whole cubes, for scaled voxels"},
    {"lad_type = spherical", FormatUse::read, "directions of leaves, as without a table (ladlut)"},
    {"lad_type = *", FormatUse::noted, "directions of leaves are spherical, or by a table (ladlut)"},
    {"columns i, j, k, PadBVTotal", FormatUse::read, "place of a voxel in the grid, and density of its leaves"},
    {"column transmittance", FormatUse::read, "1 or NaN: without a cube, for opaque and scaled voxels"},
    {"*", FormatUse::read, "nothing: other columns and keys tell how the voxels were measured"},
});

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_VOX)
#include <cmath>
#include <set>

#include <pulsecast/base/random.hpp>
#include <pulsecast/io/detail/cell_numbers.hpp>
#include <pulsecast/io/detail/text/table.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

class VoxelFileReader {
 public:
  VoxelFileReader(const std::filesystem::path& path, const VoxelFileSettings& settings)
      : settings_(validated(settings)), table_(path, "a voxel file, which begins with 'VOXEL SPACE'") {}

  [[nodiscard]] VoxelFile read() && {
    if (!table_.next() || table_.text() != "VOXEL SPACE")
      table_.refuse(table_.text(), "a voxel file, which begins with 'VOXEL SPACE'");
    for (;;) {
      if (!table_.next()) table_.fail("has no row of column names: expected 'i j k PadBVTotal ...'");
      if (!table_.text().starts_with('#')) break;
      keys();
    }
    name_columns();
    check_keys();
    while (table_.next()) table_.text().starts_with('#') ? keys() : row();
    finish();
    file_.warnings = std::move(table_.warnings);
    return std::move(file_);
  }

 private:
  static constexpr double max_number = 1e12;  ///< upper limit of numbers in a file

  /// Reads a line of `#key: value #key: value ...`.
  void keys() {
    for (std::string_view left = table_.text(); !left.empty();) {
      left.remove_prefix(1);
      const std::string_view entry = left.substr(0, left.find('#'));
      left.remove_prefix(entry.size());
      const std::size_t colon = entry.find_first_of(":=");
      if (colon == entry.npos) continue;
      std::string key = text::lower(entry.substr(0, colon));
      std::erase(key, ' ');
      const std::string_view value = entry.substr(colon + 1);
      if (!given_.insert(key).second) table_.fail_here("'", key, "' stands a second time: expected each key once");
      const bool has_angles = key == "lad_type" && settings_.use == VoxelUse::transmissive;
      keep_rule(vox_rules, table_.path(), "key", has_angles ? key + " = " + text::lower(text::trimmed(value)) : key,
                table_.warnings);
      if (key == "min_corner") min_corner_ = vector(key, value);
      if (key == "max_corner") max_corner_ = vector(key, value);
      if (key == "res") resolution(value);
      if (key == "split") {
        split_ = vector(key, value);
        for (const double count : numbers(value))
          if (!(count >= 1 && count <= 0x1p32 && std::floor(count) == count))
            table_.fail_here("'split' is ", text::quoted(value), ": expected three whole numbers from 1 to 2^32");
      } else if (key == "max_pad") {
        const std::vector<double> given = numbers(value);
        if (given.size() != 1 || !(given[0] > 0))
          table_.fail_here("'max_pad' is ", text::quoted(value), ": expected a number above 0");
        max_pad_ = given[0];
      }
    }
  }

  void resolution(std::string_view value) {
    const std::vector<double> given = numbers(value);
    if ((given.size() != 1 && given.size() != 3) || !(std::ranges::min(given) > 0))
      table_.fail_here("'res' is ", text::quoted(value), ": expected the edge of a voxel [m], above 0");
    if (given.size() == 3 && (given[1] != given[0] || given[2] != given[0]))
      table_.fail_here("'res' is ", text::quoted(value), ": expected voxels that are cubes");
    edge_ = given[0];
    edge_line_ = table_.line();
  }

  [[nodiscard]] Vec3 vector(const std::string& key, std::string_view value) const {
    const std::vector<double> given = numbers(value);
    if (given.size() != 3)
      table_.fail_here("'", key, "' is ", text::quoted(value), ": expected three numbers within 1e12");
    return {given[0], given[1], given[2]};
  }

  /// Numbers of a value, with or without brackets and commas; empty if it has anything else.
  [[nodiscard]] static std::vector<double> numbers(std::string_view value) {
    constexpr std::string_view between = " \t,()[]";
    std::vector<double> result;
    value.remove_prefix(std::min(value.find_first_not_of(between), value.size()));
    while (!value.empty()) {
      const std::optional<double> number = text::finite_number_in(text::take_word(value, between));
      if (!number || std::fabs(*number) > max_number) return {};
      result.push_back(*number);
    }
    return result;
  }

  void name_columns() {
    const std::vector<std::string_view>& names = table_.cells();
    columns_ = names.size();
    const auto find = [&](std::string_view name, bool needed = true) {
      const auto column = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
      if (column == columns_ && needed)
        table_.fail_here("no column is named '", name, "': expected a row of names, as 'i j k PadBVTotal ...'");
      return column;
    };
    index_ = {find("i"), find("j"), find("k")};
    density_ = find("PadBVTotal");
    const std::size_t transmittance = find("transmittance", settings_.use != VoxelUse::transmissive);
    if (transmittance < columns_) transmittance_ = transmittance;
  }

  void check_keys() {
    if (!min_corner_) table_.fail("has no key 'min_corner': expected '#min_corner: x y z' above the rows");
    if (!edge_) table_.fail("has no key 'res': expected '#res: edge' above the rows");
    file_.voxels.corner = *min_corner_;
    file_.voxels.edge = *edge_;
    if (const double least = VoxelData::min_edge(*min_corner_); !(*edge_ >= least))
      fail_at(table_.path(), edge_line_, "'res' is ", *edge_, ": expected at least ", least,
              " at the distance of 'min_corner' from the origin");
    if (!max_corner_ || !split_) return;
    const Vec3 should = *min_corner_ + *split_ * *edge_;
    if (!is_within(should - *max_corner_, *edge_ / 2))
      table_.warn(0, "'max_corner' contradicts 'min_corner', 'split' and 'res': it is ignored");
  }

  void row() {
    const std::vector<std::string_view>& cells = table_.cells();
    if (cells.size() < columns_) table_.fail_here("has ", cells.size(), " columns: expected ", columns_);
    const CellNumbers::Cell cell{index(0), index(1), index(2)};
    if (!is_within(*min_corner_ + Vec3(cell[0], cell[1], cell[2]) * *edge_, max_number))
      table_.fail_here("the voxel ", to_text(cell), " is beyond 1e12 m: expected coordinates up to 1e12 m");
    const double density = number(density_);
    const double transmittance = transmittance_ ? number(*transmittance_) : 0;
    if (density < 0 || density > max_number) table_.refuse(density_, "a density from 0 to 1e12");
    if (table_.line_is_open()) table_.warn(0, "the last line has no line end: the file may be truncated");
    if (cells_.size() == CellNumbers::max_size) table_.fail_here("expected fewer than 2^32 - 1 voxels");
    const std::size_t before = cells_.size();
    if (cells_.number(cell) != before)
      table_.fail_here("the voxel ", to_text(cell), " is repeated: expected each voxel once");
    density_max_ = std::fmax(density_max_, density);
    const bool is_clear = transmittance == 1 || std::isnan(transmittance);
    if (settings_.use == VoxelUse::transmissive ? density == 0 : is_clear) return;
    if (std::isnan(density) && settings_.use != VoxelUse::opaque) return no_density_.at(table_.line());
    kept_.push_back(cell);
    densities_.push_back(static_cast<float>(density));
    if (transmittance_) file_.transmittances.push_back(static_cast<float>(transmittance));
  }

  [[nodiscard]] std::uint32_t index(int axis) {
    const std::size_t column = index_[static_cast<std::size_t>(axis)];
    const auto value = text::number_in<std::uint32_t>(table_.cells()[column]);
    if (!value) table_.refuse(column, "a whole number from 0 to 2^32 - 1");
    if (split_ && !(*value < (*split_)[axis]))
      table_.refuse(column, "less than the ", (*split_)[axis], " voxels that 'split' gives");
    return *value;
  }

  [[nodiscard]] double number(std::size_t column) {
    const std::string_view text = table_.cells()[column];
    if (text::is_same_word(text, "nan") || text::is_same_word(text, "-nan"))
      return std::numeric_limits<double>::quiet_NaN();
    const std::optional<double> value = text::finite_number_in(text);
    if (!value) table_.refuse(column, "a number, with a decimal point, or NaN");
    return *value;
  }

  void finish() {
    file_.density_max = settings_.density_max.value_or(max_pad_.value_or(density_max_));
    if (settings_.use == VoxelUse::scaled && !settings_.density_max && !max_pad_)
      table_.warn(0, "has no key 'max_pad': the largest density of its rows, ", density_max_,
                  " m^2/m^3, is that of whole cubes");
    if (settings_.use == VoxelUse::scaled) scale();
    if (settings_.use == VoxelUse::transmissive) file_.voxels.densities = std::move(densities_);
    file_.voxels.cells = std::move(kept_);
    warn(no_density_, "has no density (NaN)", "they are left out");
    warn(too_dense_, text::message("is denser than the maximum, ", file_.density_max, " m^2/m^3"),
         "they fill their cells");
    if (file_.voxels.cells.empty())
      table_.fail(cells_.size() == 0 ? "has no rows: expected at least one voxel"
                                     : "has no occupied voxel: expected at least one");
  }

  /// Sets the size of each cube, and its shift if requested; removes those of size 0.
  void scale() {
    std::size_t n = 0;
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      const double share = densities_[i] > 0 ? densities_[i] / file_.density_max : 0;
      if (share > 1 + 1e-6) ++too_dense_.count;
      // source: Weiser et al. 2021, eq. 2, with the cell's edge as base size
      const auto size = static_cast<float>(std::pow(std::min(share, 1.0), settings_.exponent));
      if (!(size > 0)) continue;
      kept_[n] = kept_[i];
      if (!file_.transmittances.empty()) file_.transmittances[n] = file_.transmittances[i];
      file_.voxels.scales.push_back(size);
      if (settings_.shift) file_.voxels.shifts.push_back(shift(kept_[i], size));
      ++n;
    }
    kept_.resize(n);
    if (!file_.transmittances.empty()) file_.transmittances.resize(n);
  }

  /// Uniform shift that keeps the cube inside its cell, in edges of the cell.
  [[nodiscard]] std::array<float, 3> shift(const CellNumbers::Cell& cell, float size) const {
    const std::uint64_t first = std::uint64_t{cell[1]} << 32 | cell[0];
    const auto words = random_words({*settings_.shift, first, cell[2], Purpose::scene});
    std::array<float, 3> result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double within = (words[axis] + 0.5) * 0x1p-31 - 1;  // (-1, 1)
      result[axis] = static_cast<float>(within * (1 - double{size}) / 2);
    }
    return result;
  }

  void warn(const Oddity& of, std::string_view what, std::string_view consequence) {
    if (of.count > 0) table_.warn(of.first, "a voxel ", what, ", one of ", of.count, ": ", consequence);
  }

  [[nodiscard]] static std::string to_text(const CellNumbers::Cell& cell) {
    return text::message(cell[0], " ", cell[1], " ", cell[2]);
  }

  VoxelFileSettings settings_;
  TextTable table_;
  VoxelFile file_;
  std::optional<Vec3> min_corner_, max_corner_, split_;
  std::optional<double> edge_, max_pad_;
  std::size_t edge_line_ = 0;
  std::array<std::size_t, 3> index_{};  // column numbers
  std::size_t density_ = 0, columns_ = 0;
  std::optional<std::size_t> transmittance_;
  double density_max_ = 0;  // over all rows
  Oddity no_density_, too_dense_;
  CellNumbers cells_;                    // of all rows
  std::set<std::string> given_;          // keys
  std::vector<CellNumbers::Cell> kept_;  // of rows that become voxels
  std::vector<float> densities_;         // of these
};

}  // namespace detail

PULSECAST_INLINE VoxelFile read_voxel_file(const std::filesystem::path& path, const VoxelFileSettings& settings) {
  return reading(path, [&] { return detail::VoxelFileReader(path, settings).read(); });
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
