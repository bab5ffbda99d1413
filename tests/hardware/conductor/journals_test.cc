#include "hardware/conductor/journals.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "hardware/node/journal.h"
#include "recording/event.h"
#include "recording/event_text.h"

namespace simbench::hardware {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

FrameEvent journal_frame(std::uint32_t camera, std::uint32_t counter, double arrival_ms) {
  FrameRecord record;
  record.camera = camera;
  record.counter = counter;
  record.arrival = HostTime(from_ms(arrival_ms));
  return {record, std::nullopt};
}

std::string events_text(const std::vector<KeptEvent>& events) {
  std::string text;
  for (const KeptEvent& event : events) text += to_line(event) + "\n";
  return text;
}

HostJournal host_journal(const std::vector<KeptEvent>& events) {
  HostJournal journal;
  journal.append(events_text(events));
  return journal;
}

// "frame C/N" and "adjustment H", in the order in which they were reported.
std::vector<std::string> reported(const std::vector<HostJournal>& journals) {
  KeptRecording kept;
  kept.on_start({});
  play_in_order(journals, kept);
  std::vector<std::string> names;
  for (const KeptEvent& event : kept.events()) {
    if (const auto* frame = event_as<FrameEvent>(event)) {
      names.push_back(std::to_string(frame->record.camera) + "/" +
                      std::to_string(frame->record.counter));
    } else if (const auto* adjustment = event_as<ClockAdjustment>(event)) {
      names.push_back("clock " + std::to_string(adjustment->host));
    }
  }
  return names;
}

TEST(Journals, TextMayEndAnywhere) {
  const std::string text =
      events_text({journal_frame(0, 1, 10), journal_frame(0, 2, 20), ClockAdjustment{}});
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    HostJournal journal;
    journal.append(text.substr(0, cut));
    journal.append(text.substr(cut));
    EXPECT_EQ(journal.events().size(), 3U) << "cut at " << cut;
    EXPECT_EQ(journal.bytes(), text.size());
    EXPECT_EQ(journal.damaged(), 0U);
  }
}

TEST(Journals, ABrokenLastLineIsNotTaken) {
  const std::string text = events_text({journal_frame(0, 1, 10), journal_frame(0, 2, 20)});
  HostJournal journal;
  journal.append(text.substr(0, text.size() - 5));
  EXPECT_EQ(journal.frames(), 1U);
}

TEST(Journals, DamagedLinesAreCountedAndTheOthersKept) {
  HostJournal journal;
  journal.append("frame,nonsense\n" + events_text({journal_frame(0, 1, 10)}) + "\n\xff\xfe\n");
  EXPECT_EQ(journal.events().size(), 1U);
  EXPECT_EQ(journal.damaged(), 3U);
}

TEST(Journals, NotesAreNoEvents) {
  HostJournal journal;
  journal.append(note_line("camera 7: unplugged, it says") + "\n");
  EXPECT_THAT(journal.notes(), ElementsAre("camera 7: unplugged, it says"));
  EXPECT_THAT(journal.events(), IsEmpty());
}

TEST(Journals, FramesOfAllHostsComeInOrderOfArrival) {
  EXPECT_THAT(reported({host_journal({journal_frame(0, 1, 10), journal_frame(0, 2, 30)}),
                        host_journal({journal_frame(1, 1, 5), journal_frame(1, 2, 20),
                                      journal_frame(1, 3, 40)})}),
              ElementsAre("1/1", "0/1", "1/2", "0/2", "1/3"));
}

TEST(Journals, AHostKeepsItsOwnOrderEvenIfItsClockStepsBack) {
  EXPECT_THAT(reported({host_journal({journal_frame(0, 1, 100), journal_frame(0, 2, 10)}),
                        host_journal({journal_frame(1, 1, 50)})}),
              ElementsAre("1/1", "0/1", "0/2"));
}

TEST(Journals, WhatIsNoFrameComesBeforeTheNextFrameOfItsHost) {
  ClockAdjustment adjustment;
  adjustment.host = 1;
  EXPECT_THAT(reported({host_journal({journal_frame(0, 1, 1)}),
                        host_journal({adjustment, journal_frame(1, 1, 2), adjustment,
                                      journal_frame(1, 2, 3)})}),
              ElementsAre("clock 1", "0/1", "1/1", "clock 1", "1/2"));
}

TEST(Journals, CoveredPeriodsCountFromTheFirstFrameThroughGapsAndTheWrap) {
  EXPECT_EQ(host_journal({}).covered(0, StreamKind::kDepth), 0);
  EXPECT_EQ(host_journal({journal_frame(0, 7, 1)}).covered(0, StreamKind::kDepth), 1);
  const HostJournal gap = host_journal({journal_frame(0, 7, 1), journal_frame(0, 9, 2)});
  EXPECT_EQ(gap.covered(0, StreamKind::kDepth), 3);
  EXPECT_EQ(gap.covered(0, StreamKind::kColour), 0);
  EXPECT_EQ(gap.covered(1, StreamKind::kDepth), 0);
  const HostJournal wrapped =
      host_journal({journal_frame(0, 0xfffffffe, 1), journal_frame(0, 1, 2)});
  EXPECT_EQ(wrapped.covered(0, StreamKind::kDepth), 4);
  const HostJournal restarted = host_journal({journal_frame(0, 7, 1), journal_frame(0, 9, 2),
                                              journal_frame(0, 0, 3), journal_frame(0, 2, 4)});
  EXPECT_EQ(restarted.covered(0, StreamKind::kDepth), 5);
}

}  // namespace
}  // namespace simbench::hardware
