// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/detail/file.hpp>

#include <span>
#include <string>
#include <string_view>

#include <doctest/doctest.h>

#include "support/size_limit.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::mpi {
namespace {

using support::content;
using support::TemporaryFolder;

std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

TEST_CASE("several write to a file that one has made") {
  const TemporaryFolder folder;
  io::OutputFile whole(folder / "a.txt");
  whole.write(std::string_view("head "));
  {
    MpiFile one(folder / "a.txt"), other(folder / "a.txt");
    other.write(9, bytes("five"));
    one.write(5, bytes("four"));
    one.close();
  }
  whole.continue_at(13);
  CHECK(whole.position() == 13);
  whole.write(std::string_view(" end"));
  whole.overwrite(0, bytes("HEAD"));
  whole.commit();
  CHECK(content(folder / "a.txt") == "HEAD fourfive end");
}

TEST_CASE("a write that stops half-way is an error") {
  const TemporaryFolder folder;
  const io::OutputFile whole(folder / "a.txt");
  MpiFile file(folder / "a.txt");
  const support::SizeLimit limit(1000);
  try {
    file.write(0, bytes(std::string(1500, 'x')));
    FAIL("nothing was thrown");
  } catch (const FileError& error) {
    CHECK(std::string_view(error.what()).find("expected room for 500 more bytes") != std::string_view::npos);
  }
}

TEST_CASE("a file that is not there cannot be written to") {
  const TemporaryFolder folder;
  MpiFile file(folder / "a.txt");
  file.write(0, {});  // nothing to write, nothing wrong
  try {
    file.write(0, bytes("x"));
    FAIL("nothing was thrown");
  } catch (const FileError& error) {
    CHECK(std::string_view(error.what()).find("a.txt") != std::string_view::npos);
    CHECK(std::string_view(error.what()).find("No such file") != std::string_view::npos);
  }
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::mpi
