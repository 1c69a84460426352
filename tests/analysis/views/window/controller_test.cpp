// SPDX-License-Identifier: MIT
// Points and keys to changes of the state, over a run that is known.
#include "analysis/views/window/controller.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "analysis/views/window/facts.h"
#include "fake_source.h"

namespace stipple {
namespace {

class ControllerTest : public ::testing::Test {
 protected:
  explicit ControllerTest(int ranks = 4)
      : source(ranks),
        state(source.EndSeconds(), source.Ranks()),
        scene(source),
        controller(source, state, scene) {
    Draw();
  }
  void Draw() {
    scene.Resize(1440, 960);
    scene.Update(state, false);
  }
  Point In(int rank, double time_s) {
    const GridRow& row = scene.timeline().grid().rows[*scene.timeline().RowOfRank(rank)];
    return {scene.timeline().XOf(time_s), row.y + row.height / 2};
  }
  void Click(Point at, bool shift = false) {
    controller.Press(Button::kLeft, at, shift);
    controller.Release(at);
    Draw();
  }
  void Drag(Button button, Point from, Point to, bool shift = false) {
    controller.Press(button, from, shift);
    controller.Move({(from.x + to.x) / 2, from.y});
    controller.Release(to);
    Draw();
  }
  void Type(std::string_view text) {
    for (const char c : text) controller.Key(std::string(1, c), c, false);
  }

  testing::FakeSource source;
  ViewState state;
  WindowScene scene;
  Controller controller;
};

TEST_F(ControllerTest, ABandBecomesTheView) {
  Drag(Button::kLeft, In(1, 2), In(2, 5));
  EXPECT_NEAR(state.visible().begin_s, 2, 1e-9);
  EXPECT_NEAR(state.visible().end_s, 5, 1e-9);
  EXPECT_FALSE(controller.band());
  Drag(Button::kLeft, In(1, 4), In(1, 3));
  EXPECT_NEAR(state.visible().begin_s, 3, 1e-9) << "from the right to the left, too";
}

TEST_F(ControllerTest, TheWheelKeepsWhatIsUnderThePointer) {
  const Point at = In(0, 7.5);
  for (int i = 0; i < 10; ++i) {
    controller.Wheel(at, 1);
    Draw();
    EXPECT_NEAR(In(0, 7.5).x, at.x, 1e-6);
  }
  EXPECT_TRUE(controller.moving());
}

TEST_F(ControllerTest, DraggingWithTheOtherButtonsMovesWithThePointer) {
  state.Show({4, 6});
  Draw();
  const Point from = In(0, 5);
  const double right = from.x + 100;
  for (const auto& [button, shift] : {std::pair(Button::kOther, false), {Button::kLeft, true}}) {
    state.Show({4, 6});
    Draw();
    Drag(button, from, {right, from.y}, shift);
    EXPECT_NEAR(In(0, 5).x, right, 1e-6);
  }
}

TEST_F(ControllerTest, AClickOnAStateTellsFunctionCallAndMessage) {
  const Point in_row = In(2, 3.93);
  const GridRow& row = scene.timeline().grid().rows[*scene.timeline().RowOfRank(2)];
  Click({in_row.x, row.y + 3});
  ASSERT_TRUE(state.picked);
  EXPECT_EQ(state.picked->rank, 2);
  ASSERT_TRUE(state.picked->visit);
  EXPECT_EQ(source.RegionName(state.picked->visit->region), "MPI_Send");
  EXPECT_EQ(state.picked->path, (std::vector<std::string>{"main"}));
  ASSERT_TRUE(state.picked->message);
  EXPECT_EQ(state.picked->message->sender, 2);
  EXPECT_EQ(state.picked->message->receiver, 3);
  EXPECT_NE(FactsLine(*state.picked, source).find("message from 2 to 3, tag 7, 100 bytes"),
            std::string::npos);
}

TEST_F(ControllerTest, AClickOnALetterTellsItsMessageAndItsPartner) {
  state.Show({3.8, 4.05});
  Draw();
  ASSERT_FALSE(scene.timeline().letters.shapes.empty());
  std::set<std::pair<int, int>> found;
  for (const Shape& shape : scene.timeline().letters.shapes) {
    const auto& letter = std::get<TextShape>(shape);
    Click({letter.x, letter.y});
    ASSERT_TRUE(state.picked && state.picked->message) << letter.text;
    found.insert({state.picked->message->sender, state.picked->message->receiver});
  }
  EXPECT_EQ(found, (std::set<std::pair<int, int>>{{0, 1}, {1, 2}, {2, 3}, {3, 0}}));
}

TEST_F(ControllerTest, AClickOnALineTellsItsMessage) {
  state.Show({3.8, 4.05});
  Draw();
  for (const RunMessage& message : scene.data().messages) {
    const auto line = scene.timeline().LineOf(message);
    ASSERT_TRUE(line);
    const Point a = line->points[0], b = line->points[1];
    // In the gap next to the sender's row; no other line is there.
    Click({a.x + (b.x - a.x) * 0.04, a.y + (b.y - a.y) * 0.04});
    ASSERT_TRUE(state.picked && state.picked->message);
    EXPECT_EQ(state.picked->message->number, message.number);
  }
}

TEST_F(ControllerTest, WhereVisitsAreDrawnEachCanBeClicked) {
  state.Show({3.5, 4.5});
  Draw();
  const TimelineData& data = scene.data();
  ASSERT_EQ(data.visits.size(), 4u);
  for (std::size_t row = 0; row < 4; ++row)
    for (const VisitSpan& visit : data.visits[row].visits) {
      const auto area = scene.timeline().AreaOf(row, visit);
      if (!area || area->width < 3) continue;
      Click({area->left + area->width / 2, area->top + area->height / 2});
      ASSERT_TRUE(state.picked && state.picked->visit);
      EXPECT_EQ(state.picked->rank, static_cast<int>(row));
      EXPECT_EQ(state.picked->visit->begin_ns, visit.begin_ns);
      EXPECT_EQ(state.picked->visit->region, visit.region);
    }
}

TEST_F(ControllerTest, LabelsNarrowAndHideRanks) {
  const auto label = [&](int rank) { return Point{20, In(rank, 0).y}; };
  Click(label(2));
  EXPECT_EQ(state.ranks(), (std::vector<int>{2}));
  Click(label(2));
  EXPECT_TRUE(state.AllRanks());
  Click(label(1), true);
  EXPECT_EQ(state.ranks(), (std::vector<int>{0, 2, 3}));
}

TEST_F(ControllerTest, SearchVisitsEachRankInTimeAndTurnsBack) {
  controller.Key("slash", '/', false);
  Type("mpi_Send");
  controller.Key("Return", '\r', false);
  // The fake looks for the very letters; nothing has "mpi_Send" in it.
  EXPECT_EQ(state.message, "no later visit of 'mpi_Send'");
  controller.Key("slash", '/', false);
  Type("MPI_Send");
  controller.Key("Return", '\r', false);
  std::vector<std::pair<int, std::int64_t>> seen;
  for (int i = 0; i < 9; ++i) {
    ASSERT_TRUE(state.picked && state.picked->visit);
    seen.emplace_back(state.picked->rank, state.picked->visit->begin_ns);
    EXPECT_TRUE(state.visible().Has(state.picked->time_s));
    Type("n");
  }
  EXPECT_EQ(seen[0], std::pair(0, testing::FakeSource::kSend));
  EXPECT_EQ(seen[3], std::pair(3, testing::FakeSource::kSend));
  EXPECT_EQ(seen[8], std::pair(0, 2 * testing::FakeSource::kSecond + testing::FakeSource::kSend));
  Type("N");
  Type("N");
  EXPECT_EQ(state.picked->rank, 3);
}

TEST_F(ControllerTest, TheOverviewGoesWhereItIsClicked) {
  state.Show({1, 2});
  Draw();
  const Area& overview = scene.layout().overview;
  Click({overview.left + overview.width * 0.75, overview.top + 5});
  EXPECT_NEAR((state.visible().begin_s + state.visible().end_s) / 2, 7.5, 1e-6);
  EXPECT_NEAR(state.visible().length(), 1, 1e-9);
}

TEST_F(ControllerTest, DigitsAndTheMenuTogglePanels) {
  for (std::size_t p = 0; p < kPanelCount; ++p) {
    const bool before = state.Shows(static_cast<Panel>(p));
    Type(std::to_string(p + 1));
    EXPECT_NE(state.Shows(static_cast<Panel>(p)), before) << p;
  }
}

TEST_F(ControllerTest, NoKeyMeansTwoThings) {
  std::set<std::string> seen;
  for (const KeyRow& row : Keys()) {
    std::istringstream keys{std::string(row.keys)};
    for (std::string key; keys >> key;) {
      EXPECT_TRUE(seen.insert(key).second) << key;
      const bool alt = key.starts_with("Alt+");
      EXPECT_EQ(CommandOf(alt ? key.substr(4) : key, alt), row.command) << key;
    }
  }
}

TEST_F(ControllerTest, TheManualListsTheseKeys) {
  std::ifstream file(STIPPLE_SOURCE_DIR "/docs/stipple-view.md");
  std::ostringstream text;
  text << file.rdbuf();
  const std::string manual = text.str();
  std::size_t rows = 0;
  const auto expect = [&](std::string_view shown, std::string_view does) {
    const std::string row = "| " + std::string(shown) + " | " + std::string(does) + " |\n";
    EXPECT_NE(manual.find(row), std::string::npos) << row;
    ++rows;
  };
  for (const KeyRow& row : Keys()) expect(row.shown, row.does);
  for (const MouseRow& row : MouseActions()) expect(row.shown, row.does);
  std::size_t in_manual = 0;
  for (std::size_t at = manual.find("\n| "); at != std::string::npos;
       at = manual.find("\n| ", at + 1))
    ++in_manual;
  EXPECT_EQ(in_manual, rows + 2) << "two headings";
}

TEST_F(ControllerTest, EverythingFitsAtAnySize) {
  for (const int ranks : {1, 2, 9, 64, 1000}) {
    const testing::FakeSource many(ranks);
    ViewState shown(many.EndSeconds(), many.Ranks());
    WindowScene picture(many);
    for (const auto& [width, height] : {std::pair(1920.0, 1080.0),
                                        {1440.0, 960.0},
                                        {800.0, 600.0},
                                        {320.0, 200.0},
                                        {100.0, 50.0}}) {
      picture.Resize(width, height);
      picture.Update(shown, false);
      const WindowLayout& layout = picture.layout();
      double above = layout.timeline.bottom();
      for (const PlacedPanel& curve : layout.curves) {
        EXPECT_GE(curve.area.top - kTitleHeight, above - 1) << ranks << ' ' << height;
        above = curve.area.bottom();
      }
      for (const PlacedPanel& display : layout.displays) {
        EXPECT_GE(display.area.top - kTitleHeight, above - 1) << ranks << ' ' << height;
        EXPECT_LE(display.area.bottom(), layout.height);
      }
      const RowGrid& grid = picture.timeline().grid();
      if (height >= 600) {
        EXPECT_LE(grid.rows.front().y + grid.height + kAxisHeight, layout.timeline.bottom() + 1)
            << ranks << ' ' << height;
      }
    }
  }
}

}  // namespace
}  // namespace stipple
