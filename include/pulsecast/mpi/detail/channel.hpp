// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MPI_DETAIL_CHANNEL_HPP
#define PULSECAST_MPI_DETAIL_CHANNEL_HPP

#include <cstring>
#include <deque>
#include <exception>
#include <list>
#include <span>
#include <vector>

#define OMPI_SKIP_MPICXX 1  // C++ bindings, removed in MPI 3.0, of Open MPI and MPICH
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <pulsecast/base/require.hpp>

namespace PULSECAST_NAMESPACE::mpi {

/// Value whose bytes may be sent.
template <class T>
concept Plain = std::is_trivially_copyable_v<T>;

/// MPI environment: the first object of a program, and the last to go. Destruction by an exception
/// aborts all processes, as the others would wait for ever; messages to the user must come before.
/// Throws a `SettingError` if MPI lacks MPI_THREAD_SERIALIZED.
class MpiSession {
 public:
  MpiSession() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    if (provided < MPI_THREAD_SERIALIZED)
      throw SettingError("MPI thread level", provided, "", "MPI_THREAD_SERIALIZED at least");
  }
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
  ~MpiSession() {
    if (std::uncaught_exceptions() > exceptions_) abort(1);
    MPI_Finalize();
  }

  /// Aborts all processes at once.
  static void abort(int status) noexcept { MPI_Abort(MPI_COMM_WORLD, status); }

 private:
  int exceptions_ = std::uncaught_exceptions();
};

/// Messages and bytes sent to other processes.
struct MpiTraffic {
  std::uint64_t messages = 0, bytes = 0;
};

/// Messages among the processes of a communicator, non-blocking, in order between any two. Calls
/// may come from several threads, one at a time. Errors of MPI itself abort the program.
class MpiChannel {
 public:
  using Bytes = std::vector<std::byte>;
  struct Arrived {
    int from, kind;
    Bytes bytes;
  };

  /// Collective over `communicator`, which is duplicated.
  explicit MpiChannel(MPI_Comm communicator) {
    MPI_Comm_dup(communicator, &communicator_);
    MPI_Comm_rank(communicator_, &rank_);
    MPI_Comm_size(communicator_, &size_);
  }
  MpiChannel(const MpiChannel&) = delete;
  MpiChannel& operator=(const MpiChannel&) = delete;
  ~MpiChannel() {
    if (std::uncaught_exceptions() > exceptions_) return;  // receivers may be gone
    for (Sent& sent : sent_) MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
    MPI_Comm_free(&communicator_);
  }

  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] bool first() const noexcept { return rank_ == 0; }
  [[nodiscard]] const MpiTraffic& traffic() const noexcept { return traffic_; }

  /// Sends bytes, at most 2 GiB, with a tag `kind`. Throws a `SettingError` above that.
  void send(int to, int kind, Bytes bytes) {
    constexpr int most = std::numeric_limits<int>::max();
    require_within("MPI message size", bytes.size(), 0, most, "bytes");
    if (to == rank_) return void(to_itself_.push_back({rank_, kind, std::move(bytes)}));
    ++traffic_.messages;
    traffic_.bytes += bytes.size();
    auto& [own, request] = sent_.emplace_back(Sent{std::move(bytes), MPI_REQUEST_NULL});
    MPI_Isend(own.data(), static_cast<int>(own.size()), MPI_BYTE, to, kind, communicator_, &request);
  }

  /// Calls handle(from, kind, bytes) for every message that has arrived; true if there was any.
  template <class Handle>
  bool poll(const Handle& handle) {
    std::erase_if(sent_, [](Sent& sent) {
      int done = 0;
      MPI_Test(&sent.request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
    bool any = false;
    for (; !to_itself_.empty(); any = true) {
      Arrived message = std::move(to_itself_.front());
      to_itself_.pop_front();
      handle(message.from, message.kind, std::move(message.bytes));
    }
    for (;; any = true) {
      int there = 0, size = 0;
      MPI_Status status;
      MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, communicator_, &there, &status);
      if (there == 0) return any;
      MPI_Get_count(&status, MPI_BYTE, &size);
      Bytes bytes(static_cast<std::size_t>(size));
      const int from = status.MPI_SOURCE, kind = status.MPI_TAG;
      MPI_Recv(bytes.data(), size, MPI_BYTE, from, kind, communicator_, MPI_STATUS_IGNORE);
      handle(from, kind, std::move(bytes));
    }
  }

  /// Calls `meanwhile` repeatedly until all processes have reached the barrier.
  template <class Meanwhile>
  void barrier(const Meanwhile& meanwhile) {
    MPI_Request request;
    MPI_Ibarrier(communicator_, &request);
    for (int done = 0; done == 0;) {
      meanwhile();
      MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    }
  }

  /// Values of all processes by rank, on the first; empty on the others.
  template <Plain Value>
  [[nodiscard]] std::vector<Value> gather(const Value& own) const {
    std::vector<Value> all(first() ? static_cast<std::size_t>(size_) : 0);
    constexpr int size = sizeof(Value);
    MPI_Gather(&own, size, MPI_BYTE, all.data(), size, MPI_BYTE, 0, communicator_);
    return all;
  }

  /// Value of the first process, on all.
  [[nodiscard]] std::string from_first(std::string text) const {
    std::uint64_t size = text.size();
    MPI_Bcast(&size, sizeof size, MPI_BYTE, 0, communicator_);
    text.resize(size);
    MPI_Bcast(text.data(), static_cast<int>(size), MPI_BYTE, 0, communicator_);
    return text;
  }
  template <Plain Value>
  [[nodiscard]] Value from_first(Value value) const {
    MPI_Bcast(&value, sizeof value, MPI_BYTE, 0, communicator_);
    return value;
  }

 private:
  struct Sent {
    Bytes bytes;
    MPI_Request request;
  };

  MPI_Comm communicator_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1, exceptions_ = std::uncaught_exceptions();
  std::list<Sent> sent_;  // in transit
  std::deque<Arrived> to_itself_;
  MpiTraffic traffic_;
};

/// Byte message, values appended and read back in the same order.
class MpiMessage {
 public:
  MpiMessage() = default;
  explicit MpiMessage(MpiChannel::Bytes bytes) : bytes_(std::move(bytes)) {}

  template <Plain Value>
  MpiMessage& add(const Value& value) {
    return add(std::span(&value, 1));
  }
  template <Plain Value, std::size_t Extent>
  MpiMessage& add(std::span<Value, Extent> values) {
    const auto added = std::as_bytes(values);
    bytes_.insert(bytes_.end(), added.begin(), added.end());
    return *this;
  }
  [[nodiscard]] MpiChannel::Bytes take() && { return std::move(bytes_); }

  template <Plain Value>
  [[nodiscard]] Value next() {
    Value value{};
    PULSECAST_ASSERT(at_ + sizeof value <= bytes_.size());
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  template <Plain Value>
  void next(std::vector<Value>& values, std::size_t count) {
    values.resize(count);
    PULSECAST_ASSERT(at_ + count * sizeof(Value) <= bytes_.size());
    if (count > 0) std::memcpy(values.data(), bytes_.data() + at_, count * sizeof(Value));
    at_ += count * sizeof(Value);
  }
  /// Removes and returns the value appended last.
  template <Plain Value>
  [[nodiscard]] Value last() {
    Value value{};
    PULSECAST_ASSERT(at_ + sizeof value <= bytes_.size());
    std::memcpy(&value, bytes_.data() + bytes_.size() - sizeof value, sizeof value);
    bytes_.erase(bytes_.end() - sizeof value, bytes_.end());
    return value;
  }
  [[nodiscard]] std::span<const std::byte> rest() const noexcept { return std::span(bytes_).subspan(at_); }

 private:
  MpiChannel::Bytes bytes_;
  std::size_t at_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::mpi

#endif
