// SPDX-License-Identifier: MIT
#include "analysis/exemplar/run_store.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>

#include "analysis/trace/input_error.h"
#include "analysis/trace/parallel.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

std::string ReadWhole(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A file that is there is whole.
void WriteAtOnce(const std::string& text, const std::string& path) {
  const std::string unfinished = path + ".new";
  std::ofstream out(unfinished, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw InputError(path, "cannot be written");
  fs::rename(unfinished, path);
}

std::string LastLineOf(const std::string& path) {
  std::ifstream in(path);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

RunMeasures RunStore::Measure(const SimulatedRun& simulated, const std::string& key) const {
  const std::string base = folder + "/" + key;
  const std::string archive = base + ".stipple", said = base + ".txt";
  const std::string command = CommandLineOf(simulated);
  if (const int status = run(WordsOf(simulated, archive), said); status != 0)
    throw InputError(command, fmt::format("exit status {}: {}", status, LastLineOf(said)));
  RunMeasures measures = MeasureArchive(archive);
  WriteAtOnce(JsonOf(measures, command), base + ".json");
  fs::remove_all(archive);
  fs::remove(said);
  return measures;
}

std::vector<RunMeasures> RunStore::MeasureAll(std::span<const Case> cases) const {
  fs::create_directories(folder);
  std::map<std::string, std::optional<RunMeasures>> by_key;
  std::vector<std::string> keys;
  std::vector<std::size_t> missing;  // of cases, one for each key
  for (std::size_t i = 0; i < cases.size(); ++i) {
    keys.push_back(KeyOf(cases[i].run, program));
    const auto [kept, is_new] = by_key.try_emplace(keys.back());
    if (!is_new) continue;
    kept->second = MeasuresFrom(ReadWhole(folder + "/" + keys.back() + ".json"));
    if (!kept->second) missing.push_back(i);
  }
  std::mutex mutex;
  std::size_t done = 0;
  if (!missing.empty()) progress(0, missing.size());
  ForEachIndex(missing.size(), [&](std::size_t m) {
    const std::string& key = keys[missing[m]];
    RunMeasures measures = Measure(cases[missing[m]].run, key);
    const std::lock_guard lock(mutex);
    by_key[key] = std::move(measures);
    progress(++done, missing.size());
  });
  std::vector<RunMeasures> all;
  for (const std::string& key : keys) all.push_back(*by_key[key]);
  return all;
}

}  // namespace stipple
