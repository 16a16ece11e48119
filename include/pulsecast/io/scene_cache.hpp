// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_SCENE_CACHE_HPP
#define PULSECAST_IO_SCENE_CACHE_HPP

#include <pulsecast/io/detail/archive.hpp>
#include <pulsecast/io/detail/digest.hpp>
#include <pulsecast/io/output_file.hpp>
#include <pulsecast/material/microfacet.hpp>
#include <pulsecast/material/normalized_phong.hpp>
#include <pulsecast/material/reflectance_map.hpp>
#include <pulsecast/material/retroreflector.hpp>
#include <pulsecast/material/tabulated.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/version.hpp>

/// Cache of a built scene: one memory-mapped file.
///
/// A cache belongs to one build of the program on one machine: arrays keep their memory layout. It
/// is used only if complete, by a checksum over all bytes, and made by this version, for these
/// shapes and element types, from the present bytes of its sources. Forgery is detected as far as a
/// shape has `is_consistent`. Limits: a mapped file must not be written to. Caches are replaced as
/// a whole, which leaves mapped ones intact; but two programs should not make one at once.
namespace PULSECAST_NAMESPACE::io {

/// Geometry that can be kept in a cache. A function names all members, for writing and reading:
///
///     explicit G(DeserializeTag) {}
///     template <class Archive> void archive(Archive& a) { a(member1_, member2_, ...); }
///
/// Members may be `SharedArray` arrays, which stay in the file, plain values without pointers,
/// strings, vectors, and objects with an `archive`. Not required: `bool is_consistent() const`,
/// called after the filling: true if all indices in the arrays are in bounds.
template <class G>
concept Archived = Geometry<G> && detail::Restorable<G>;

namespace detail {
/// Laws that a cache keeps.
using KnownLaw = std::variant<Lambert, DirectionIndependent, Phong, NormalizedPhong, Retroreflector<Beads>,
                              Retroreflector<CubeCorners>, Tabulated, Microfacet>;

/// A law as one of them; empty for a user-defined one.
[[nodiscard]] inline std::optional<KnownLaw> known_law(const SurfaceLaw& law) {
  std::optional<KnownLaw> known;
  [&]<class... Laws>(const std::variant<Laws...>*) {
    ((law.get<Laws>() ? void(known = *law.get<Laws>()) : void()), ...);
  }(static_cast<const KnownLaw*>(nullptr));
  return known;
}

template <Archived... Shapes>
void require_archived(std::span<const Part<Shapes...>> parts);

}  // namespace detail

/// Scene of parts whose shapes are all `Archived`: `Scene` and `MovingScene`.
template <class S>
concept CacheableScene = requires(const S& scene) {
  detail::require_archived(std::span<const typename S::Part>(scene.parts()));
};

/// Inputs of a scene.
struct SceneSources {
  std::vector<std::filesystem::path> files{};  ///< files of the build; of a folder, all
  std::string settings{};                      ///< all else that the scene depends on, as text
};

/// Result of opening a cache.
template <class S>
struct OpenedScene {
  std::optional<S> scene;  ///< empty if the cache is unusable
  std::string reason;      ///< reason without a scene, as in "is truncated"; else empty
};

/// Scene and its origin.
template <class S>
struct CachedScene {
  S scene;                  ///< from the cache or built
  bool from_cache = false;  ///< true if it comes from the cache
  std::string reason;       ///< reason for building it; empty if it comes from the cache
  std::string warning;      ///< reason for not saving it; empty if saved or from the cache
};

void list_members(auto& a, Tabulated& law) { a(law.rows); }
/// Lists a law, one of the library's own.
template <class Archive>
void list_members(Archive& a, SurfaceLaw& law) {
  detail::KnownLaw known;
  if constexpr (std::same_as<Archive, ArchiveWriter>) known = detail::known_law(law).value();
  a(known);
  if constexpr (std::same_as<Archive, ArchiveReader>)
    law = std::visit([](const auto& is) -> SurfaceLaw { return is; }, known);
}
/// Lists the members of a material. A new member of a material or part is a compile error here.
void list_members(auto& a, Material& m) {
  auto& [name, reflectance, law, classification, ground, spectrum, smooth, colour, picture, reflectance_map] = m;
  auto map = std::dynamic_pointer_cast<const ReflectanceMap>(reflectance_map);
  a(name, reflectance, law, classification, ground, spectrum, colour, picture, map);
  reflectance_map = std::move(map);
  auto& [kind, mirrored, thickness, inside] = smooth;
  auto& [index, group_index, absorption, volume_scattering, backscatter] = inside;
  a(kind, mirrored, thickness, index, group_index, absorption, volume_scattering, backscatter);
}
void list_members(auto& a, ReflectanceMap& map) { a(map.image, map.wavelengths, map.mean); }
void list_members(auto& a, Attribute& attribute) {
  auto& [name, value] = attribute;
  a(name, value);
}
template <class... Shapes>
void list_members(auto& a, Part<Shapes...>& part) {
  auto& [geometry, materials, placement, object, name, motion, attributes] = part;
  a(geometry, materials, placement, object, name, attributes);
  if constexpr (detail::Restorable<PartMotion>) a(motion);
}

namespace detail {

/// Header of a cache.
struct CacheHeader {
  std::array<char, 8> mark{'P', 'C', 'S', 'C', 'E', 'N', 'E', '\n'};
  std::uint32_t order = 0x01020304;  ///< reads differently in another byte order
  std::uint32_t format = 11;         ///< version of the layout of the file
  Fingerprint program;               ///< hash of the library's version and the types in the file
  Fingerprint key;                   ///< key of the sources
  std::uint64_t size = 0;            ///< size of the file [byte]
  std::uint64_t unused[7] = {};
  Fingerprint checksum;  ///< over all other bytes of the file
};
static_assert(sizeof(CacheHeader) == 128 && std::is_trivially_copyable_v<CacheHeader>);

/// Checksum of a cache over everything except the checksum itself.
[[nodiscard]] inline Fingerprint checksum_of(CacheHeader header, const Digest& rest) {
  Digest digest;
  digest.add(rest.value());
  header.checksum = {};
  digest.add(std::as_bytes(std::span(&header, 1)));
  return digest.value();
}

/// Fingerprint of the part type of a file and of the library's version.
template <class P>
[[nodiscard]] Fingerprint program_of() {
  Digest digest;
  digest.add(std::string_view(PULSECAST_VERSION));
  digest.add(std::string_view(typeid(P).name()));
  digest.add(std::uint64_t{sizeof(P)} << 32 | sizeof(void*));
  return digest.value();
}

/// Defect of bytes as a cache of this program from these sources; null if they are complete.
[[nodiscard]] inline const char* defect_of(std::span<const std::byte> bytes, const Fingerprint& program,
                                           const Fingerprint& key) {
  const CacheHeader own;
  CacheHeader header;
  if (bytes.size() < sizeof header) return "is truncated";
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.mark != own.mark) return "is not a scene cache";
  if (header.order != own.order || header.format != own.format || header.program != program)
    return "was written by another version of the program, or for other shapes";
  if (header.size != bytes.size()) return "is truncated, or has grown";
  if (header.key != key) return "is out of date: a source or a setting has changed";
  Digest rest;
  rest.add(bytes.subspan(sizeof header));
  return header.checksum != checksum_of(header, rest) ? "is damaged: its checksum is wrong" : nullptr;
}

/// Parts in a checked cache, which `owner` keeps alive. @throws ArchiveError @throws SettingError
template <class P>
[[nodiscard]] std::vector<P> parts_in(std::span<const std::byte> bytes, std::shared_ptr<const void> owner) {
  ArchiveReader reader(bytes.subspan(sizeof(CacheHeader)), std::move(owner));
  std::vector<P> parts;
  reader(parts);
  reader.require_end();
  return parts;
}

}  // namespace detail

/// Key of the present sources. The order of the files matters, their paths do not. `content` gives
/// the fingerprint of each, as of a file already read. @throws FileError if one cannot be read
[[nodiscard]] inline Fingerprint scene_key(
    const SceneSources& sources,
    const std::function<Fingerprint(const std::filesystem::path&)>& content = content_fingerprint) {
  Digest digest;
  digest.add(std::string_view(sources.settings));
  for (const std::filesystem::path& path : sources.files) digest.add(content(path));
  return digest.value();
}

/// Writes a cache. @throws FileError
template <CacheableScene S>
void save_scene(const std::filesystem::path& path, const S& scene, const Fingerprint& key) {
  const std::span<const typename S::Part> parts = scene.parts();
  OutputFile file(path);
  detail::CacheHeader header;
  const auto header_bytes = std::as_bytes(std::span(&header, 1));
  file.write(header_bytes);  // placeholder
  Digest digest;
  ArchiveWriter writer([&](std::span<const std::byte> bytes) {
    digest.add(bytes);
    file.write(bytes);
  });
  writer(std::uint64_t{parts.size()});
  for (const auto& part : parts) {
    if (part.motion && !detail::Restorable<PartMotion>)
      detail::fail(path, "cannot be written: motions of parts are not supported");
    for (const Material& material : *part.materials)
      if (const auto* const map = material.reflectance_map.get();
          !detail::known_law(material.law) || (map && !dynamic_cast<const ReflectanceMap*>(map)))
        detail::fail(path, "cannot be written: the material '", material.name,
                     "' has a user-defined law of scattering or map of reflectances");
    writer(part);
  }
  header.program = detail::program_of<typename S::Part>();
  header.key = key;
  header.size = file.position();
  header.checksum = detail::checksum_of(header, digest);
  file.overwrite(0, header_bytes);
  file.commit();
}

/// Opens a cache; a defect is the reason of none. The scene is made of its parts and `further`.
template <CacheableScene S, class... Further>
[[nodiscard]] OpenedScene<S> open_scene(const std::filesystem::path& path, const Fingerprint& key,
                                        const Further&... further) {
  try {
    const auto file = std::make_shared<const MappedFile>(path);
    const char* const defect = detail::defect_of(file->bytes(), detail::program_of<typename S::Part>(), key);
    if (defect) return {std::nullopt, defect};
    return {S(detail::parts_in<typename S::Part>(file->bytes(), file), further...), {}};
  } catch (const FileError& error) {
    return {std::nullopt, error.problem()};
  } catch (const ArchiveError& error) {
    return {std::nullopt, std::string("is damaged: ") + error.what()};
  } catch (const SettingError& error) {
    return {std::nullopt, std::string("is damaged: ") + error.what()};
  }
}

/// Scene from a cache; without one of these sources, of the parts that `build` returns, saved for
/// the next time. The scene is made of its parts and `further`, as needed by a `MovingScene`.
template <CacheableScene S, class Build, class... Further>
[[nodiscard]] CachedScene<S> cached_scene(const std::filesystem::path& path, const SceneSources& sources, Build&& build,
                                          const Further&... further) {
  std::optional<Fingerprint> key;
  std::string reason;
  try {
    key = scene_key(sources);
    OpenedScene<S> opened = open_scene<S>(path, *key, further...);
    if (opened.scene) return {*std::move(opened.scene), true, {}, {}};
    reason = path.string() + " " + opened.reason;
  } catch (const FileError& error) {
    reason = error.what();
  }
  CachedScene<S> made{S(std::forward<Build>(build)(), further...), false, reason, {}};
  if (!key) {
    made.warning = "The scene is not saved, as its sources cannot be read: " + reason;
    return made;
  }
  try {
    save_scene(path, made.scene, *key);
  } catch (const FileError& error) {
    made.warning = error.what();
  }
  return made;
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
