#include "algorithms/host_sync/huygens/network_effect.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <deque>
#include <set>

namespace simbench {
namespace {

// Each pass multiplies the error by the rate, which is far below 1e-2.
constexpr int kInverseRounds = 4;
constexpr std::size_t kDrawsPerPair = 20;

// Numbers the hosts that pairs connect with host 0, from 0 on; nothing for the others.
std::vector<std::optional<Eigen::Index>> connected(const std::vector<PairLead>& pairs,
                                                   std::size_t hosts) {
  std::vector<std::vector<PeerId>> neighbours(hosts);
  for (const PairLead& pair : pairs) {
    neighbours[pair.a].push_back(pair.b);
    neighbours[pair.b].push_back(pair.a);
  }
  std::vector<std::optional<Eigen::Index>> numbers(hosts);
  std::deque<PeerId> open = {0};
  Eigen::Index next = 0;
  numbers[0] = next++;
  for (; !open.empty(); open.pop_front()) {
    for (const PeerId neighbour : neighbours[open.front()]) {
      if (numbers[neighbour]) continue;
      numbers[neighbour] = next++;
      open.push_back(neighbour);
    }
  }
  return numbers;
}

}  // namespace

std::vector<std::optional<double>> loop_corrected(const std::vector<PairLead>& pairs,
                                                  std::size_t hosts) {
  const std::vector<std::optional<Eigen::Index>> numbers = connected(pairs, hosts);
  const auto count = static_cast<Eigen::Index>(
      std::count_if(numbers.begin(), numbers.end(), [](const auto& n) { return n.has_value(); }));
  // Normal equations of lead = offset(b) - offset(a), with host 0's offset held at 0.
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(count);
  for (const PairLead& pair : pairs) {
    if (!numbers[pair.a]) continue;
    const Eigen::Index a = *numbers[pair.a];
    const Eigen::Index b = *numbers[pair.b];
    laplacian(a, a) += 1;
    laplacian(b, b) += 1;
    laplacian(a, b) -= 1;
    laplacian(b, a) -= 1;
    sums(a) -= pair.lead_ns;
    sums(b) += pair.lead_ns;
  }
  const Eigen::Index others = count - 1;
  const Eigen::VectorXd solved =
      laplacian.bottomRightCorner(others, others).ldlt().solve(sums.tail(others));
  std::vector<std::optional<double>> offsets(hosts);
  for (std::size_t host = 0; host < hosts; ++host) {
    if (!numbers[host]) continue;
    offsets[host] = *numbers[host] == 0 ? 0 : solved(*numbers[host] - 1);
  }
  return offsets;
}

namespace {

// What `to` reads while `from` reads `reading`, by the line of the two.
std::int64_t reading_across(const PairLines& lines, PeerId from, PeerId to, std::int64_t reading) {
  if (from < to) return reading + lines.at({from, to}).lead_at(reading);
  const PairLine& line = lines.at({to, from});
  std::int64_t x = reading - line.lead_ns;
  for (int round = 0; round < kInverseRounds; ++round) x = reading - line.lead_at(x);
  return x;
}

// What each host's raw clock reads while host 0's reads x, by the fewest lines.
std::vector<std::optional<std::int64_t>> readings_at(const PairLines& lines, std::int64_t x_ns,
                                                     std::size_t hosts) {
  std::vector<std::vector<PeerId>> neighbours(hosts);
  for (const auto& [pair, line] : lines) {
    neighbours[pair.first].push_back(pair.second);
    neighbours[pair.second].push_back(pair.first);
  }
  std::vector<std::optional<std::int64_t>> readings(hosts);
  readings[0] = x_ns;
  for (std::deque<PeerId> open = {0}; !open.empty(); open.pop_front()) {
    const PeerId host = open.front();
    for (const PeerId neighbour : neighbours[host]) {
      if (readings[neighbour]) continue;
      readings[neighbour] = reading_across(lines, host, neighbour, *readings[host]);
      open.push_back(neighbour);
    }
  }
  return readings;
}

}  // namespace

std::vector<std::optional<std::int64_t>> loop_corrected_leads(const PairLines& lines,
                                                              std::int64_t x_ns,
                                                              std::size_t hosts) {
  const std::vector<std::optional<std::int64_t>> readings = readings_at(lines, x_ns, hosts);
  // What the lines say beyond those readings: small, so that doubles are exact enough.
  std::vector<PairLead> beyond;
  beyond.reserve(lines.size());
  for (const auto& [pair, line] : lines) {
    const auto& [a, b] = pair;
    if (!readings[a]) continue;
    const std::int64_t lead = line.lead_at(*readings[a]);
    beyond.push_back({a, b, static_cast<double>(lead - (*readings[b] - *readings[a]))});
  }
  const std::vector<std::optional<double>> corrections = loop_corrected(beyond, hosts);
  std::vector<std::optional<std::int64_t>> leads(hosts);
  for (std::size_t host = 0; host < hosts; ++host) {
    if (!readings[host] || !corrections[host]) continue;
    leads[host] = *readings[host] - x_ns + from_ns(*corrections[host]).count();
  }
  return leads;
}

std::vector<std::pair<PeerId, PeerId>> probed_pairs(std::size_t hosts, std::size_t neighbours,
                                                    const std::function<double()>& uniform) {
  std::set<std::pair<PeerId, PeerId>> pairs;
  const auto count = static_cast<PeerId>(hosts);
  if (hosts <= neighbours + 1) {
    for (PeerId b = 1; b < count; ++b) {
      for (PeerId a = 0; a < b; ++a) pairs.emplace(a, b);
    }
    return {pairs.begin(), pairs.end()};
  }
  for (PeerId host = 0; host < count; ++host) {
    pairs.insert(std::minmax(host, static_cast<PeerId>((host + 1) % count)));
  }
  // As many draws as suffice, and no more if `uniform` repeats itself.
  const std::size_t draws = kDrawsPerPair * hosts * neighbours;
  for (std::size_t i = 0; i < draws && 2 * pairs.size() < hosts * neighbours; ++i) {
    const auto a = static_cast<PeerId>(uniform() * static_cast<double>(hosts));
    const auto b = static_cast<PeerId>(uniform() * static_cast<double>(hosts));
    if (a != b) pairs.insert(std::minmax(a, b));
  }
  return {pairs.begin(), pairs.end()};
}

}  // namespace simbench
