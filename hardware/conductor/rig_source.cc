#include "hardware/conductor/rig_source.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <exception>
#include <utility>
#include <vector>

#include "hardware/conductor/journals.h"
#include "hardware/conductor/rig_session.h"

namespace simbench::hardware {

RigSource::RigSource(Rig rig, SecretKey key, const scenarios::Scenario& scenario,
                     RigSourceSettings settings)
    : rig_(std::move(rig)),
      key_(std::move(key)),
      scenario_(scenario),
      settings_(std::move(settings)) {
  check_rig_is_guarded(rig_, key_.is_secret());
  check_rig_fits(rig_, scenario_);
}

RecordingCost RigSource::record(const RecordingRequest& request, RecordingSink& sink) {
  boost::asio::io_context context(1);
  RecordingCost cost;
  std::vector<HostJournal> journals;
  {
    RigSession session(context, rig_, key_, scenario_, request, settings_);
    session_ = session.id();
    std::exception_ptr failure;
    boost::asio::co_spawn(context,
                          settings_.collect_session.empty() ? session.conduct() : session.collect(),
                          [&](const std::exception_ptr& thrown) {
                            failure = thrown;
                            context.stop();
                          });
    context.run();
    hosts_ = session.reports();
    if (failure) std::rethrow_exception(failure);
    sink.on_start(session.layout());
    cost.notes = session.notes();
    journals = session.take_journals();
  }
  play_in_order(journals, sink);
  return cost;
}

}  // namespace simbench::hardware
