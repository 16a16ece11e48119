// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/gzip.hpp>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/text_files.hpp>

#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::Generator;
using support::TemporaryFolder;

/// What one gzip member holds; throws if there is anything wrong with it, its checksum and length too, or anything
/// behind it.
std::string unzipped(const std::string& bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) throw std::runtime_error("no memory");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::string text, block(1 << 16, '\0');
  int result = Z_OK;
  while (result == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = static_cast<uInt>(block.size());
    result = inflate(&stream, Z_NO_FLUSH);
    text.append(block, 0, block.size() - stream.avail_out);
  }
  const bool rest = stream.avail_in != 0;
  inflateEnd(&stream);
  if (result != Z_STREAM_END || rest) throw std::runtime_error("not a good gzip file");
  return text;
}

std::string zipped(const std::string& text, const GzipSettings& settings = {}) {
  const TemporaryFolder folder;
  OutputFile file = gzip_file(folder / "a.gz", settings);
  file.write(text);
  file.commit();
  return content(folder / "a.gz");
}

TEST_CASE("a file says that it is gzip, and neither its name nor the time; nothing is twenty bytes") {
  const std::string bytes = zipped("");
  CHECK(bytes.substr(0, 8) == std::string("\x1F\x8B\x08\0\0\0\0\0", 8));
  CHECK(bytes.size() == 20);
  CHECK(unzipped(bytes).empty());
}

TEST_CASE("whatever is written reads back, at every level and in pieces of every size") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const TemporaryFolder folder;
    const GzipSettings settings{.level = static_cast<int>(1 + random.whole(9))};
    OutputFile file = gzip_file(folder / "a.gz", settings);
    std::string expected;
    for (int i = 0; i < 12; ++i) {
      std::string piece(static_cast<std::size_t>(random.log_uniform(1, 3e6)), ' ');
      for (char& c : piece)
        c = static_cast<char>(seed % 2 == 0 ? random.whole(256) : '0' + random.whole(10));  // hardly and well
      file.write(piece);
      expected += piece;
    }
    CHECK(file.position() == expected.size());
    file.commit();
    const std::string bytes = content(folder / "a.gz");
    CHECK((unzipped(bytes) == expected));
    if (seed % 2 == 1) CHECK(bytes.size() < expected.size() / 2);
    CHECK((bytes == zipped(expected, settings) || seed % 2 == 0));  // how it is cut does not matter
  }
}

TEST_CASE("every text writer writes compressed what it writes else") {
  const TemporaryFolder folder;
  Generator random(1);
  std::vector<Shot> shots(1000);
  std::vector<Echo> echoes(shots.size());
  std::vector<float> samples(10 * shots.size(), 1e-9F);
  std::vector<SubrayRecord> subrays(2 * shots.size());
  for (std::uint32_t i = 0; i < shots.size(); ++i) {
    shots[i].index = i;
    shots[i].origin = random.point(1e6);
    shots[i].direction = random.unit();
    shots[i].first_echo = i;
    shots[i].echoes = 1;
    shots[i].first_sample = 10 * i;
    shots[i].samples = 10;
    echoes[i].range = subrays[2 * i].range = random.log_uniform(1, 1000);
  }
  const EchoBatch batch{shots, echoes, samples, 1e-9, subrays};
  const auto same = [&](auto plain, auto compressed) {
    plain(batch);
    compressed(batch);
    plain.close();
    compressed.close();
    const std::string text = content(folder / "a.txt");
    CHECK(text.size() > 10 * shots.size());
    CHECK((unzipped(content(folder / "a.gz")) == text));
  };
  same(XyzWriter(folder / "a.txt"), XyzWriter(gzip_file(folder / "a.gz")));
  same(PulseTextWriter(folder / "a.txt"), PulseTextWriter(gzip_file(folder / "a.gz")));
  same(WaveformTextWriter(folder / "a.txt"), WaveformTextWriter(gzip_file(folder / "a.gz")));
  same(SubrayTextWriter(folder / "a.txt"), SubrayTextWriter(gzip_file(folder / "a.gz")));
}

TEST_CASE("a file that is not committed leaves nothing; a full disk is an error; a level must be one of zlib's") {
  const TemporaryFolder folder;
  { gzip_file(folder / "a.gz").write("lost"); }
  CHECK(folder.empty());
  std::filesystem::create_symlink("/dev/full", folder / "a.gz.part");
  OutputFile file = gzip_file(folder / "a.gz");
  file.write("x");
  CHECK_THROWS_AS(file.commit(), FileError);
  CHECK_THROWS_AS(static_cast<void>(gzip_file(folder / "a.gz", {.level = 0})), SettingError);
  CHECK_THROWS_AS(static_cast<void>(gzip_file(folder / "a.gz", {.level = 10})), SettingError);
  CHECK(folder.empty());
}

TEST_CASE("the decompressor that the tests trust notices whatever is wrong") {
  const std::string good = zipped("some text, some text");
  CHECK(unzipped(good) == "some text, some text");
  CHECK_THROWS(unzipped(good.substr(0, good.size() - 1)));
  CHECK_THROWS(unzipped(good + "x"));
  for (std::size_t i : {std::size_t{0}, good.size() - 8, good.size() - 1}) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 1);
    CHECK_THROWS(unzipped(bad));
  }
}

}  // namespace
}  // namespace pulsecast::io
