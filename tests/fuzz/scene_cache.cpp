// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Opening a scene cache that someone has tampered with, and tracing what it holds. The input says what is changed in a
// cache that was just saved, so that it never goes stale; the header and its checksum are made right again, as they
// would stop nearly every input. The shapes are those whose `is_consistent` is complete, down to the nodes of their
// trees.
//
// The first byte chooses the scene, or (from 128 on) that all other bytes are the file behind its header. Then come
// changes: two bytes of position, one byte of which the upper half is the kind (even: overwritten; 1 mod 4: inserted; 3
// mod 4: cut off there) and the lower half the number of bytes that follow, less one.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>
#include <pulsecast/io/scene_cache.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "fuzz/fuzz.hpp"
#include "support/generators.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

namespace {

using Tested = Scene<TriangleMesh<KdTree<>>, TriangleMesh<Linear<double>>>;
constexpr Fingerprint key{};

std::string saved(const Tested& scene) {
  const support::TemporaryFolder folder;
  save_scene(folder / "cache", scene, key);
  return support::content(folder / "cache");
}

std::array<std::string, 2> saved_scenes() {
  const auto spectrum = std::make_shared<const Spectrum>(std::vector<SpectralSample>{{0.5e-6, 0.1}, {1e-6, 0.4}});
  const MaterialTable materials =
      material_table({{.name = "bark", .spectrum = spectrum}, {.name = "moss", .ground = true, .spectrum = spectrum}});
  support::Generator random(1);
  MeshData few{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}}, {{0, 1, 2}, {1, 2, 3}}, {0, 1}};
  const auto small = std::make_shared<const TriangleMesh<Linear<double>>>(few);
  const auto tree = std::make_shared<const TriangleMesh<KdTree<>>>(support::soup(random, 30, 1));
  return {saved(Tested({{.geometry = small, .materials = materials, .name = "one"},
                        {.geometry = small, .materials = materials, .placement = {.translation = {0, 0, 1}}}})),
          saved(Tested({{.geometry = tree}, {.geometry = tree, .placement = {.scale = 2}, .object = 7}}))};
}

std::string tampered(const std::uint8_t* data, std::size_t size) {
  static const std::array<std::string, 2> scenes = saved_scenes();
  const std::size_t header = sizeof(io::detail::CacheHeader);
  if (data[0] >= 128)
    return scenes[0].substr(0, header) + std::string(reinterpret_cast<const char*>(data + 1), size - 1);
  std::string file = scenes[data[0] % scenes.size()];
  for (std::size_t at = 1; at + 3 < size;) {
    const std::size_t position = header + (data[at] + 256U * data[at + 1]) % (file.size() - header + 1);
    const unsigned kind = data[at + 2] >> 4;
    const std::size_t count = std::min<std::size_t>((data[at + 2] & 15U) + 1, size - at - 3);
    const std::string bytes(reinterpret_cast<const char*>(data + at + 3), count);
    if (kind % 2 == 0) {
      file.replace(position, std::min(count, file.size() - position), bytes);
    } else if (kind % 4 == 1) {
      file.insert(position, bytes);
    } else {
      file.resize(position);
    }
    at += 3 + count;
  }
  return file;
}

/// As a file is mapped: at the beginning of a page.
std::shared_ptr<std::byte> mapped(const std::string& file) {
  constexpr auto page = std::align_val_t{4096};
  const std::shared_ptr<std::byte> memory(new (page) std::byte[file.size()],
                                          [](std::byte* bytes) { ::operator delete[](bytes, page); });
  std::memcpy(memory.get(), file.data(), file.size());
  return memory;
}

void seal(std::string& file) {
  io::detail::CacheHeader header;
  header.program = io::detail::program_of<Tested::Part>();
  header.key = key;
  header.size = file.size();
  io::Digest rest;
  rest.add(std::as_bytes(std::span(file)).subspan(sizeof header));
  header.checksum = io::detail::checksum_of(header, rest);
  std::memcpy(file.data(), &header, sizeof header);
}

void trace(const Tested& scene) {
  support::Generator random(3);
  std::array<Hit, 8> hits;
  for (int i = 0; i < 10; ++i) scene.closest(random.cone(random.point(2), random.unit(), 1, hits.size()), hits);
  (void)scene.ground_height({0.3, 0.3});
}

}  // namespace

FUZZ_TARGET(scene_cache) {
  if (size == 0) return;
  std::string file = tampered(data, size);
  seal(file);
  const std::shared_ptr<std::byte> memory = mapped(file);
  const std::span<const std::byte> bytes(memory.get(), file.size());
  fuzz::expect(!io::detail::defect_of(bytes, io::detail::program_of<Tested::Part>(), key));  // the header is right
  try {
    trace(Tested(io::detail::parts_in<Tested::Part>(bytes, memory)));
  } catch (const ArchiveError&) {
  } catch (const SettingError&) {
  }
}
