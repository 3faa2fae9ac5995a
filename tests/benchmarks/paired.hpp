#pragma once

#include <benchmark/benchmark.h>

#include <chrono>

namespace raytruth::benchmarks {

/// Times `subject` and `peer` in turn in every iteration, so that a drift of the machine's speed meets both alike, and
/// reports the seconds of each and `speedup`, the peer's time over the subject's.
template <class Subject, class Peer>
void run_paired(benchmark::State& state, Subject&& subject, Peer&& peer) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](auto&& work) {
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(work());
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  double subject_seconds = 0;
  double peer_seconds = 0;
  for ([[maybe_unused]] auto _ : state) {
    const double of_subject = seconds(subject);
    const double of_peer = seconds(peer);
    subject_seconds += of_subject;
    peer_seconds += of_peer;
    state.SetIterationTime(of_subject + of_peer);
  }
  const auto iterations = static_cast<double>(state.iterations());
  state.counters["subject_seconds"] = subject_seconds / iterations;
  state.counters["peer_seconds"] = peer_seconds / iterations;
  state.counters["speedup"] = peer_seconds / subject_seconds;
}

}  // namespace raytruth::benchmarks
