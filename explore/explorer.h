// The page of `simbench explore`: what each address of it answers.
//
//   ""            the page
//   subject       GET: {"subject", "scenarios": [{"name", "summary"}], "figures": [{"id",
//   "title"}],
//                 "first_seeds", "most_seeds", "version"}
//   parameters    POST {"state"}: {"parameters": parameters_json(), "choices": pipelines_json()} of
//                 its scenario, without its changes
//   look          POST a look (look.h): a stream of its events, or of its text
//   scenario.json, command.txt, script.py
//                 POST {"state", "seeds"}: what does the same without a page
//
// A state that is refused: status 422, {"pointer", "message"}.
//
// Threads: answers are made on the server's thread, but for looks.
//
//   Explorer explorer({.name = "18cam_6host_45fps"});
//   server::LocalServer server({}, [&](const auto& request) { return explorer.answer(request); });
#pragma once

#include "explore/looks.h"
#include "explore/state.h"
#include "server/request.h"

namespace simbench::explore {

class Explorer {
 public:
  explicit Explorer(PageSubject subject);

  server::PageResponse answer(const server::PageRequest& request);

 private:
  server::PageResponse subject_response() const;
  server::PageResponse made_of(const std::string& path, const reports::Json& body) const;
  server::PageResponse look(const reports::Json& body);

  const PageSubject subject_;
  Looks looks_;
};

}  // namespace simbench::explore
