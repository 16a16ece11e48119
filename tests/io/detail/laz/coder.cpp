// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/laz/coder.hpp>

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laz_reader.hpp"

namespace pulsecast::io::detail {
namespace {

using support::Generator;
using support::LazBitShares;
using support::LazDecoder;
using support::LazShares;

std::string finished(LazEncoder encoder) {
  const std::vector<std::byte> bytes = std::move(encoder).finish();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Codes symbols of one model.
template <std::size_t Capacity>
std::string coded(const std::vector<std::size_t>& symbols, std::size_t of) {
  LazModel<Capacity> model(of);
  LazEncoder encoder;
  for (const std::size_t symbol : symbols) encoder.encode(model, symbol);
  return finished(std::move(encoder));
}

TEST_CASE("nothing is four bytes, which a decoder looks ahead") {
  CHECK(finished(LazEncoder()) == std::string(4, '\0'));
  CHECK(LazDecoder(finished(LazEncoder())).at_end());
}

TEST_CASE("bits that nothing is known of stand as they are") {
  LazEncoder encoder;
  for (const std::uint32_t byte : {0x12U, 0x34U, 0xFFU, 0x00U, 0x9AU}) encoder.encode_bits(byte, 8);
  const std::string bytes = finished(std::move(encoder));
  CHECK(bytes.size() == 9);
  LazDecoder decoder(bytes);
  for (const std::uint32_t byte : {0x12U, 0x34U, 0xFFU, 0x00U, 0x9AU}) CHECK(decoder.decode_bits(8) == byte);
}

TEST_CASE("symbols of alphabets of all sizes come back, whatever their shares") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const auto of = static_cast<std::size_t>(random.log_uniform(2, 256.99));
    const double skew = random.log_uniform(0.05, 20);
    std::vector<std::size_t> symbols(20'000);
    for (std::size_t& symbol : symbols)
      symbol = std::min(of - 1, static_cast<std::size_t>(std::pow(random.uniform(), skew) * static_cast<double>(of)));
    LazDecoder decoder(coded<256>(symbols, of));
    LazShares shares(of);
    std::size_t wrong = 0;
    for (const std::size_t symbol : symbols) wrong += decoder.decode(shares) != symbol ? 1U : 0U;
    CHECK(wrong == 0);
    CHECK(decoder.at_end());
  }
}

TEST_CASE("an alphabet may be larger than a byte") {
  Generator random(7);
  std::vector<std::size_t> symbols(5'000);
  for (std::size_t& symbol : symbols) symbol = random.whole(515);
  LazDecoder decoder(coded<515>(symbols, 515));
  LazShares shares(515);
  std::size_t wrong = 0;
  for (const std::size_t symbol : symbols) wrong += decoder.decode(shares) != symbol ? 1U : 0U;
  CHECK(wrong == 0);
}

TEST_CASE("symbols, bits and plain numbers of all lengths come back from one stream") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const double ones = random.uniform();
    struct Item {
      unsigned kind, count;
      std::uint32_t value;
    };
    std::vector<Item> items(5'000);
    LazEncoder encoder;
    LazModel<> model(9);
    LazBitModel bits;
    for (Item& item : items) {
      item = {static_cast<unsigned>(random.whole(3)), static_cast<unsigned>(1 + random.whole(32)), 0};
      if (item.kind == 0) encoder.encode(model, item.value = static_cast<std::uint32_t>(random.whole(9)));
      if (item.kind == 1) encoder.encode(bits, (item.value = random.uniform() < ones ? 1 : 0) == 1);
      if (item.kind == 2)
        encoder.encode_bits(item.value = static_cast<std::uint32_t>(random.whole(std::uint64_t{1} << item.count)), item.count);
    }
    LazDecoder decoder(finished(std::move(encoder)));
    LazShares shares(9);
    LazBitShares bit_shares;
    std::size_t wrong = 0;
    for (const Item& item : items) {
      const std::uint64_t value = item.kind == 0   ? decoder.decode(shares)
                                  : item.kind == 1 ? std::uint64_t{decoder.decode(bit_shares)}
                                                   : decoder.decode_bits(item.count);
      wrong += value != item.value ? 1U : 0U;
    }
    CHECK(wrong == 0);
    CHECK(decoder.at_end());
  }
}

TEST_CASE("a carry goes through all bytes of 255 before it") {
  LazEncoder encoder;
  for (int i = 0; i < 100; ++i) encoder.encode_bits(255, 8);  // the greatest number of 100 bytes, but for what rounding leaves
  LazModel<2> model(2);
  for (int i = 0; i < 2'000; ++i) encoder.encode(model, 1);
  LazDecoder decoder(finished(std::move(encoder)));
  for (int i = 0; i < 100; ++i) CHECK(decoder.decode_bits(8) == 255);
  LazShares shares(2);
  std::size_t wrong = 0;
  for (int i = 0; i < 2'000; ++i) wrong += decoder.decode(shares) != 1 ? 1U : 0U;
  CHECK(wrong == 0);
}

TEST_CASE("the bytes are as many as the entropy of the symbols asks for") {
  Generator random(3);
  for (const double share : {0.5, 0.9, 0.99}) {
    CAPTURE(share);
    std::vector<std::size_t> symbols(200'000);
    std::size_t zeros = 0;
    for (std::size_t& symbol : symbols) zeros += (symbol = random.uniform() < share ? 0 : 1) == 0 ? 1U : 0U;
    const double p = static_cast<double>(zeros) / 200'000;
    const double entropy = -p * std::log2(p) - (1 - p) * std::log2(1 - p);
    const double bits = 8 * static_cast<double>(coded<2>(symbols, 2).size()) / 200'000;
    CHECK(bits > entropy);
    CHECK(bits < 1.03 * entropy + 0.002);
  }
}

}  // namespace
}  // namespace pulsecast::io::detail
