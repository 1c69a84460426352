// SPDX-License-Identifier: MIT
#include "analysis/exemplar/result_files.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "analysis/report/text.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

using Json = nlohmann::ordered_json;

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json NameOrNull(const std::optional<Verdict>& verdict) {
  return verdict ? Json(std::string(NameOf(*verdict))) : Json(nullptr);
}

Json JsonOfPart(const ClaimPart& part) {
  Json json = {{"text", part.text}, {"verdict", NameOrNull(VerdictOf(part))}};
  json["checks"] = Json::array();
  for (const Check& c : part.checks)
    json["checks"].push_back(Json{{"what", c.what},
                                  {"value", NumberOrNull(c.value)},
                                  {"relation", std::string(SignOf(c.relation))},
                                  {"limit", c.limit},
                                  {"holds", c.Holds()}});
  return json;
}

Json JsonOfSetting(const PaperResult& result, std::size_t index) {
  const MeasuredSetting& setting = result.settings[index];
  const Variation& v = setting.variation;
  Json json = {{"parameter", v.parameter.empty() ? "reference" : v.parameter},
               {"value", v.value},
               {"compared_only", v.compared}};
  const std::vector<Case> cases = result.experiment->cases(setting.setting, result.quick);
  json["runs"] = Json::array();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const RunMeasures& m = setting.cases[i].measures;
    json["runs"].push_back(Json{{"labels", cases[i].labels},
                                {"command", CommandLineOf(cases[i].run)},
                                {"simulated_s", m.simulated_s},
                                {"messages", m.messages},
                                {"hash", m.hash}});
  }
  json["parts"] = Json::array();
  for (const ClaimPart& part : result.parts[index].parts) json["parts"].push_back(JsonOfPart(part));
  return json;
}

void WriteText(const std::string& text, const std::string& path) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw InputError(path, "cannot be written");
}

}  // namespace

std::string ResultJson(const PaperResult& result) {
  const Judgement& j = result.judgement;
  Json json = {{"experiment", std::string(result.experiment->name)},
               {"machine", result.machine},
               {"quick", result.quick},
               {"claim", std::string(result.experiment->claim)},
               {"verdict", NameOrNull(j.verdict)},
               {"verdict_at_reference", NameOrNull(j.reference)},
               {"sentence", result.account.sentence},
               {"cause", result.account.cause}};
  json["turns"] = Json::array();
  for (const Turn& t : j.turns)
    json["turns"].push_back(Json{{"part", result.parts.front().parts[t.part].text},
                                 {"parameter", t.parameter},
                                 {"from", t.from},
                                 {"to", t.to},
                                 {"before", std::string(NameOf(t.before))},
                                 {"after", std::string(NameOf(t.after))}});
  json["settings"] = Json::array();
  for (std::size_t i = 0; i < result.settings.size(); ++i)
    json["settings"].push_back(JsonOfSetting(result, i));
  return json.dump(1) + "\n";
}

void WriteResultFiles(const PaperResult& result, const std::string& folder) {
  const std::string base = folder + "/";
  const std::string name(result.experiment->name);
  WriteText(ResultJson(result), base + name + ".json");
  WriteText(TableCsv(result.account.causes), base + name + "-causes.csv");
  for (const Figure& figure : result.account.figures)
    WriteText(TableCsv(figure.table), base + figure.name + ".csv");
}

}  // namespace stipple
