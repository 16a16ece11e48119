// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/archive.hpp>
#include <pulsecast/io/digest.hpp>
#include <pulsecast/io/mapped_file.hpp>
#include <pulsecast/io/output_file.hpp>
#include <pulsecast/scene/material.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/part.hpp>
#include <pulsecast/version.hpp>

/// A built scene in one file, which is mapped into memory rather than read.
///
/// A cache belongs to one build of the program on one machine: it holds arrays as they stand in memory, and says which version, shapes and
/// element types it was written with. It is taken only if it is whole, by a checksum over all its bytes, and if it was made from the very
/// bytes that its sources hold now. The checksum is there for accidents; what was forged is caught as far as a shape has a `is_consistent`.
/// Limits: a file that is mapped must not be written to. Caches are only ever replaced as a whole, which does not touch a mapped one; but
/// programs that start at the same time should not make the same cache.
namespace pulsecast::io {

/// A geometry that can be kept in a cache. All it holds is named, in the same order for writing and reading, by one function; all its
/// arrays are `SharedArray`, so that they can stay in the file:
///     explicit G(DeserializeTag) {}
///     template <class Archive> void archive(Archive& a) { a(member1_, member2_, ...); }
/// The members may be `SharedArray` arrays, plain values without pointers, strings, vectors, and objects that have an `archive` themselves.
/// Not required: `bool is_consistent() const`, which is asked after the filling whether every number in the arrays can be followed without
/// leaving them.
template <class G>
concept Archived = Geometry<G> && detail::Restorable<G>;

namespace detail {
template <Archived... Shapes>
void require_archived(std::span<const Part<Shapes...>> parts);
}  // namespace detail

/// A scene of parts, all of whose shapes are `Archived`: `Scene` and `MovingScene`.
template <class S>
concept CacheableScene = requires(const S& scene) {
  detail::require_archived(std::span<const typename S::Part>(scene.parts()));
};

/// What a scene is made from.
struct SceneSources {
  std::vector<std::filesystem::path> files{};  ///< all that the build reads; of a folder all files in it, their names included
  std::string settings{};                      ///< whatever else the scene depends on, in words
};

/// The key of sources as they are now. Where the files are does not matter, their order does. Throws a `FileError` if one cannot be read.
/// `content` gives the fingerprint of each: whoever has read them already spares reading them again.
[[nodiscard]] Fingerprint scene_key(const SceneSources& sources,
                                    const std::function<Fingerprint(const std::filesystem::path&)>& content = content_fingerprint);

/// Writes a cache. Throws a `FileError` if it cannot be written.
template <CacheableScene S>
void save_scene(const std::filesystem::path& path, const S& scene, const Fingerprint& key);

/// What became of the opening of a cache.
template <class S>
struct OpenedScene {
  std::optional<S> scene;
  std::string reason;  ///< why there is none, as in "is cut short"; empty if there is one
};

/// Opens a cache. Whatever is wrong with it, there is no scene then, and a reason. The scene is made from its parts and `further`.
template <CacheableScene S, class... Further>
[[nodiscard]] OpenedScene<S> open_scene(const std::filesystem::path& path, const Fingerprint& key, const Further&... further);

/// A scene, and where it comes from.
template <class S>
struct CachedScene {
  S scene;
  bool from_cache = false;
  std::string reason;   ///< why it was built; empty if it comes from the cache
  std::string warning;  ///< why it was not saved; empty if it was, or comes from the cache
};

/// The scene of a cache; if there is no cache, or it is not that of the sources, what `build` makes, which is saved for the next time.
/// `build` gives the parts. What it throws passes through. The scene is made from its parts and `further`, as a `MovingScene` needs it.
template <CacheableScene S, class Build, class... Further>
[[nodiscard]] CachedScene<S> cached_scene(const std::filesystem::path& path, const SceneSources& sources, Build&& build,
                                          const Further&... further);

/// What materials and parts hold; with one member more in either, this does not compile.
template <class Archive>
void list_members(Archive& a, Material& m) {
  auto& [name, reflectance, scattering, specular_share, specular_exponent, classification, ground, spectrum] = m;
  a(name, reflectance, scattering, specular_share, specular_exponent, classification, ground, spectrum);
}
template <class Archive, class... Shapes>
void list_members(Archive& a, Part<Shapes...>& part) {
  auto& [geometry, materials, placement, object, name, motion] = part;
  a(geometry, materials, placement, object, name);
  if constexpr (detail::Restorable<PartMotion>) a(motion);
}

namespace detail {

/// What a cache begins with.
struct CacheHeader {
  static constexpr std::array<char, 8> own_mark{'P', 'C', 'S', 'C', 'E', 'N', 'E', '\n'};
  static constexpr std::uint32_t own_order = 0x01020304;  ///< reads otherwise where bytes stand in another order
  static constexpr std::uint32_t own_format = 2;          ///< counts the ways in which what follows was written

  std::array<char, 8> mark = own_mark;
  std::uint32_t order = own_order, format = own_format;
  Fingerprint program;     ///< of the library's version and the types in the file
  Fingerprint key;         ///< of the sources
  std::uint64_t size = 0;  ///< of the file [byte]
  std::uint64_t unused[7] = {};
  Fingerprint checksum;  ///< over all other bytes of the file
};
static_assert(sizeof(CacheHeader) == 128 && std::is_trivially_copyable_v<CacheHeader>);

/// Where the checksum of a cache ends up is not part of it; everything else is.
[[nodiscard]] inline Fingerprint checksum_of(CacheHeader header, const Digest& rest) {
  Digest digest;
  digest.add(rest.value());
  header.checksum = {};
  digest.add(std::as_bytes(std::span(&header, 1)));
  return digest.value();
}
[[nodiscard]] inline Fingerprint checksum_of(const CacheHeader& header, std::span<const std::byte> rest) {
  Digest digest;
  digest.add(rest);
  return checksum_of(header, digest);
}

/// Says which part type a file holds and which library wrote it.
template <class P>
[[nodiscard]] Fingerprint program_of() {
  Digest digest;
  digest.add(std::string_view(PULSECAST_VERSION));
  digest.add(std::string_view(typeid(P).name()));
  digest.add(std::uint64_t{sizeof(P)} << 32 | sizeof(void*));
  return digest.value();
}

/// Why a cache cannot be taken.
struct Unusable {
  std::string reason;
};

/// Whether the bytes are a cache of this program, whole and from these sources; throws `Unusable` if not.
inline void require_cache(std::span<const std::byte> bytes, const Fingerprint& program, const Fingerprint& key) {
  CacheHeader header;
  if (bytes.size() < sizeof header) throw Unusable{"is cut short"};
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.mark != CacheHeader::own_mark) throw Unusable{"is no scene cache"};
  if (header.order != CacheHeader::own_order || header.format != CacheHeader::own_format || header.program != program)
    throw Unusable{"was written by another version of the program, or for other shapes"};
  if (header.size != bytes.size()) throw Unusable{"is cut short, or has grown"};
  if (header.key != key) throw Unusable{"was made from something else: a source or a setting has changed"};
  if (header.checksum != checksum_of(header, bytes.subspan(sizeof header))) throw Unusable{"is damaged: its checksum is wrong"};
}

/// The parts in the bytes of a cache that was found to be whole; `owner` keeps them where they are. Throws an `ArchiveError`, or the
/// `SettingError` of what a part is made from.
template <class P>
[[nodiscard]] std::vector<P> parts_in(std::span<const std::byte> bytes, std::shared_ptr<const void> owner) {
  ArchiveReader reader(bytes.subspan(sizeof(CacheHeader)), std::move(owner));
  std::vector<P> parts;
  reader(parts);
  reader.require_end();
  return parts;
}

}  // namespace detail

inline Fingerprint scene_key(const SceneSources& sources, const std::function<Fingerprint(const std::filesystem::path&)>& content) {
  Digest digest;
  digest.add(std::string_view(sources.settings));
  for (const std::filesystem::path& path : sources.files) digest.add(content(path));
  return digest.value();
}

template <CacheableScene S>
void save_scene(const std::filesystem::path& path, const S& scene, const Fingerprint& key) {
  const std::span<const typename S::Part> parts = scene.parts();
  OutputFile file(path);
  detail::CacheHeader header;
  const auto header_bytes = std::as_bytes(std::span(&header, 1));
  file.write(header_bytes);  // to be made true at last
  ArchiveWriter writer(file);
  writer(std::uint64_t{parts.size()});
  for (const typename S::Part& part : parts) {
    if (part.motion && !detail::Restorable<PartMotion>) throw FileError(path.string(), "", "cannot be written: motions are not kept");
    writer(part);
  }
  header.program = detail::program_of<typename S::Part>(), header.key = key, header.size = file.position();
  header.checksum = detail::checksum_of(header, writer.digest());
  file.overwrite(0, header_bytes);
  file.commit();
}

template <CacheableScene S, class... Further>
OpenedScene<S> open_scene(const std::filesystem::path& path, const Fingerprint& key, const Further&... further) {
  try {
    const auto file = std::make_shared<const MappedFile>(path);
    detail::require_cache(file->bytes(), detail::program_of<typename S::Part>(), key);
    return {S(detail::parts_in<typename S::Part>(file->bytes(), file), further...), {}};
  } catch (const detail::Unusable& unusable) {
    return {std::nullopt, unusable.reason};
  } catch (const FileError& error) {
    return {std::nullopt, error.problem()};
  } catch (const ArchiveError& error) {
    return {std::nullopt, std::string("is damaged: ") + error.what()};
  } catch (const SettingError& error) {
    return {std::nullopt, std::string("is damaged: ") + error.what()};
  }
}

template <CacheableScene S, class Build, class... Further>
CachedScene<S> cached_scene(const std::filesystem::path& path, const SceneSources& sources, Build&& build, const Further&... further) {
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
    made.warning = "The scene is not saved, as it cannot be said what it was made from: " + reason;
    return made;
  }
  try {
    save_scene(path, made.scene, *key);
  } catch (const FileError& error) {
    made.warning = error.what();
  }
  return made;
}

}  // namespace pulsecast::io
