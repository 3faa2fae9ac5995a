#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace raytruth::benchmarks {

template <class Work>
double seconds_of(Work&& work) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  benchmark::DoNotOptimize(work());
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Times `subject` and `peer` in turn in every iteration, so that a drift of the machine's speed meets both alike, and
/// reports the seconds of each and `speedup`, the peer's time over the subject's.
template <class Subject, class Peer>
void run_paired(benchmark::State& state, Subject&& subject, Peer&& peer) {
  double subject_seconds = 0;
  double peer_seconds = 0;
  for ([[maybe_unused]] auto _ : state) {
    const double of_subject = seconds_of(subject);
    const double of_peer = seconds_of(peer);
    subject_seconds += of_subject;
    peer_seconds += of_peer;
    state.SetIterationTime(of_subject + of_peer);
  }
  const auto iterations = static_cast<double>(state.iterations());
  state.counters["subject_seconds"] = subject_seconds / iterations;
  state.counters["peer_seconds"] = peer_seconds / iterations;
  state.counters["speedup"] = peer_seconds / subject_seconds;
}

/// One of several, by the name that its counters get.
struct Peer {
  std::string name;
  std::function<double()> work;
};

/// Times the subject against the fastest of several peers, which the label names; `speedup_over_<name>` for each of
/// them.
template <class Subject>
void run_against_fastest(benchmark::State& state, Subject&& subject, const std::vector<Peer>& peers) {
  double subject_seconds = 0;
  std::vector<double> peer_seconds(peers.size());
  for ([[maybe_unused]] auto _ : state) {
    double all = seconds_of(subject);
    subject_seconds += all;
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const double of_peer = seconds_of(peers[i].work);
      peer_seconds[i] += of_peer;
      all += of_peer;
    }
    state.SetIterationTime(all);
  }
  const auto iterations = static_cast<double>(state.iterations());
  const auto fastest = std::min_element(peer_seconds.begin(), peer_seconds.end());
  state.SetLabel("against " + peers[static_cast<std::size_t>(fastest - peer_seconds.begin())].name);
  state.counters["subject_seconds"] = subject_seconds / iterations;
  state.counters["peer_seconds"] = *fastest / iterations;
  state.counters["speedup"] = *fastest / subject_seconds;
  for (std::size_t i = 0; i < peers.size(); ++i)
    state.counters["speedup_over_" + peers[i].name] = peer_seconds[i] / subject_seconds;
}

}  // namespace raytruth::benchmarks
