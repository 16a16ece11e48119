// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SCENE_FILES_HPP
#define PULSECAST_HELIOS_DETAIL_SCENE_FILES_HPP

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/helios/detail/named_files.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/mtl.hpp>
#include <pulsecast/io/world_file.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Files of a scene in all runs, each once: those in its settings, the material files of OBJ files, and their pictures. Missing files are
/// left out; the builder of the scene reports them.
[[nodiscard]] std::vector<std::filesystem::path> scene_files(const SceneSettings& scene);

/// True if an MTL file declares a ground material, in any run, or cannot be read. A scene without one has no height for `onGround`.
[[nodiscard]] bool has_ground(const SceneSettings& scene);

/// Folders of spectra: `spectra` in each folder of assets that has it.
[[nodiscard]] std::vector<std::filesystem::path> spectra_folders(const std::vector<std::filesystem::path>& assets);

namespace detail {

template <class Source>
concept WithMaterial = requires(Source source) {
  source.material;
};
template <class Source>
concept WithLeafAngles = requires(Source source) {
  source.leaf_angles;
};
template <class Source>
concept WithNameTable = requires(Source source) {
  source.materials;
};
template <class Source>
concept WithClasses = requires(Source source) {
  source.classes;
};

class SceneFiles {
 public:
  void add(const PartSource& source) {
    std::visit(
        [this](const auto& s) {
          for (const std::filesystem::path& file : s.files)
            if (add(file) && (std::is_same_v<decltype(s), const ObjSource&> || text::lower(file.extension().string()) == ".obj"))
              add_materials(file);
          if constexpr (WithMaterial<decltype(s)>) add_material(s.material.file);
          if constexpr (WithLeafAngles<decltype(s)>) add(s.leaf_angles);
          if constexpr (WithNameTable<decltype(s)>) {
            add_material(s.materials);
            for (const std::filesystem::path& file : s.files)
              for (const std::filesystem::path& named : files_named_in(file)) add(named);
          }
          if constexpr (WithClasses<decltype(s)>) {
            add(s.classes);
            for (const std::filesystem::path& file : s.files) add(io::world_file_of(file));
            add(io::world_file_of(s.classes));
          }
        },
        source);
  }

  [[nodiscard]] std::vector<std::filesystem::path> take() { return std::move(files_); }
  [[nodiscard]] const std::vector<std::filesystem::path>& materials() const noexcept { return materials_; }  ///< MTL files among them

 private:
  /// Adds a file. Returns true if it exists and is new.
  bool add(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored) || !seen_.insert(file).second) return false;
    files_.push_back(file);
    return true;
  }

  /// Adds an MTL file, and the pictures that it names.
  void add_material(const std::filesystem::path& file) {
    if (!add(file)) return;
    materials_.push_back(file);
    try {
      for (const auto& [name, pictures] : io::read_mtl(file).pictures)
        for (const io::PictureSource* picture : {&pictures.colour, &pictures.opacity, &pictures.reflectance}) add(picture->file);
    } catch (const FileError&) {  // unreadable
    }
  }

  /// Adds the files that `mtllib` in an OBJ file may name.
  void add_materials(const std::filesystem::path& obj) {
    try {
      const io::MappedFile file(obj);
      const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()), keyword = "mtllib";
      for (std::size_t at = text.find(keyword); at != text.npos; at = text.find(keyword, at)) {
        at += keyword.size();
        std::size_t end = std::min(text.find('\n', at), text.size());
        while (end < text.size() && text.substr(at, end - at).find_last_of('\\') != text.npos &&
               text.substr(at, end - at).find_last_not_of(" \t\r") == text.substr(at, end - at).find_last_of('\\'))
          end = std::min(text.find('\n', end + 1), text.size());  // continued line
        add_named(obj.parent_path(), std::string(text.substr(at, end - at)));
      }
    } catch (const FileError&) {  // unreadable
    }
  }

  /// Adds names separated by blanks, and the whole as one name with blanks.
  void add_named(const std::filesystem::path& folder, std::string names) {
    constexpr const char* blanks = " \t\r\n";
    std::replace(names.begin(), names.end(), '\\', '/');
    const std::size_t first = names.find_first_not_of(blanks);
    if (first == names.npos) return;
    add_material(folder / names.substr(first, names.find_last_not_of(blanks) + 1 - first));
    for (std::size_t word = first; word != names.npos;) {
      const std::size_t end = std::min(names.find_first_of(blanks, word), names.size());
      add_material(folder / names.substr(word, end - word));
      word = names.find_first_not_of(blanks, end);
    }
  }

  std::vector<std::filesystem::path> files_, materials_;
  std::set<std::filesystem::path> seen_;
};

inline SceneFiles files_of(const SceneSettings& scene) {
  SceneFiles files;
  for (const PartSettings& part : scene.parts) {
    files.add(part.source);
    for (const SwapSettings& swap : part.swaps)
      if (swap.source) files.add(*swap.source);
  }
  return files;
}

/// True if an MTL file has a ground material, or cannot be read.
inline bool declares_ground(const std::filesystem::path& file) {
  try {
    const auto materials = io::read_mtl(file).materials;
    return std::any_of(materials.begin(), materials.end(), [](const auto& named) { return named.second.ground; });
  } catch (const FileError&) {
    return true;
  }
}

}  // namespace detail

inline std::vector<std::filesystem::path> scene_files(const SceneSettings& scene) { return detail::files_of(scene).take(); }

inline std::vector<std::filesystem::path> spectra_folders(const std::vector<std::filesystem::path>& assets) {
  std::vector<std::filesystem::path> folders;
  for (const std::filesystem::path& folder : assets) {
    std::error_code error;
    if (std::filesystem::is_directory(folder / "spectra", error)) folders.push_back(folder / "spectra");
  }
  return folders;
}

inline bool has_ground(const SceneSettings& scene) {
  const detail::SceneFiles files = detail::files_of(scene);
  return std::any_of(files.materials().begin(), files.materials().end(), detail::declares_ground);
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
