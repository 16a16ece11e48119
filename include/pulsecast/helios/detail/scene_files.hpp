// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SCENE_FILES_HPP
#define PULSECAST_HELIOS_DETAIL_SCENE_FILES_HPP

#include <set>

#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/mtl.hpp>

namespace PULSECAST_NAMESPACE::helios {

class SceneFiles final : public FieldIo {
 public:
  explicit SceneFiles(const SceneSettings& scene) {
    for (const PartSettings& part : scene.parts) {
      add(part.source);
      for (const SwapSettings& swap : part.swaps)
        if (swap.source) add(*swap.source);
    }
  }
  void file(const char* name, std::filesystem::path& file) override {
    if (file.empty()) return;
    all.insert(file);
    if (std::string_view(name).starts_with("mat")) mtls.insert(file);  // `matfile`, `materials`
  }

  std::set<std::filesystem::path> all{}, objs{}, mtls{};  ///< OBJ and MTL files are among them

 private:
  void add(PartSource source) {
    const auto add_fields = [&](auto& of_kind) {
      of_kind.fields(*this);
      for (std::filesystem::path& path : of_kind.files) {
        file("", path);
        if (std::holds_alternative<ObjSource>(source) || text::lower(path.extension().string()) == ".obj")
          objs.insert(path);
      }
    };
    std::visit(add_fields, source);
  }
};

/// Adds the files of names separated by blanks, and of the whole as one name with blanks.
inline void add_named(std::set<std::filesystem::path>& files, const std::filesystem::path& folder, std::string names) {
  constexpr const char* blanks = " \t\r\n";
  std::replace(names.begin(), names.end(), '\\', '/');
  const std::size_t first = names.find_first_not_of(blanks);
  if (first == names.npos) return;
  files.insert(folder / names.substr(first, names.find_last_not_of(blanks) + 1 - first));
  for (std::size_t word = first; word != names.npos;) {
    const std::size_t end = std::min(names.find_first_of(blanks, word), names.size());
    files.insert(folder / names.substr(word, end - word));
    word = names.find_first_not_of(blanks, end);
  }
}

/// Adds the files that `mtllib` in an OBJ file may name.
inline void add_libraries(std::set<std::filesystem::path>& files, const std::filesystem::path& obj) {
  try {
    const io::MappedFile file(obj);
    const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()),
        keyword = "mtllib";
    const auto is_continued = [&](std::size_t at, std::size_t end) {
      const std::size_t last = text.substr(at, end - at).find_last_not_of(" \t\r");
      return last != text.npos && text[at + last] == '\\';
    };
    for (std::size_t at = text.find(keyword); at != text.npos; at = text.find(keyword, at)) {
      at += keyword.size();
      std::size_t end = std::min(text.find('\n', at), text.size());
      while (end < text.size() && is_continued(at, end)) end = std::min(text.find('\n', end + 1), text.size());
      add_named(files, obj.parent_path(), std::string(text.substr(at, end - at)));
    }
  } catch (const FileError&) {  // unreadable
  }
}

/// True if an MTL file that is there has a ground material, or cannot be read.
inline bool declares_ground(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  try {
    return std::ranges::any_of(io::read_mtl(file).materials, [](const auto& named) { return named.second.ground; });
  } catch (const FileError&) {
    return true;
  }
}

/// Files in the settings of a scene, in all runs, existing or not.
[[nodiscard]] inline std::set<std::filesystem::path> scene_files(const SceneSettings& scene) {
  return SceneFiles(scene).all;
}

/// Folders of spectra, there or not: `spectra` in each folder of assets.
[[nodiscard]] inline std::vector<std::filesystem::path> spectra_folders(
    const std::vector<std::filesystem::path>& assets) {
  std::vector<std::filesystem::path> folders;
  for (const std::filesystem::path& folder : assets) folders.push_back(folder / "spectra");
  return folders;
}

/// True if an MTL file, of any run, declares a ground material for `onGround`, or cannot be read.
[[nodiscard]] inline bool has_ground(const SceneSettings& scene) {
  SceneFiles files(scene);
  for (const std::filesystem::path& obj : files.objs) add_libraries(files.mtls, obj);
  return std::ranges::any_of(files.mtls, declares_ground);
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
