// Files and folders that nobody is to find after the program: half-written results, temporary
// folders.
//
// Each is removed by the destructor of the object that made it. A program that ends without
// destructors - the last resort of Ctrl-C (cli/interrupt_deadline.h) - calls dispose_of_all()
// before.
//
//   Disposable folder([] {
//     std::filesystem::create_directory("half");
//     return "half";
//   });
//   use(folder.path());
#pragma once

#include <filesystem>
#include <functional>

namespace simbench {

class Disposable {
 public:
  // `make` makes the file or folder and returns its path. Throws what `make` throws.
  explicit Disposable(const std::function<std::filesystem::path()>& make);
  ~Disposable();
  Disposable(const Disposable&) = delete;
  Disposable& operator=(const Disposable&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Calls `change`, which adds files to the folder, at a moment when dispose_of_all() is not at
  // work.
  void change(const std::function<void()>& change) const;
  // Calls `publish`, which gives the file or folder another name; once it has returned, there is
  // nothing to remove. Throws what `publish` throws.
  void keep(const std::function<void()>& publish);

 private:
  std::filesystem::path path_;
};

// Removes all of them. From then on, functions of Disposable never return: the program is about to
// end, on the thread that calls this. Thread-safe; the work of other threads may go on.
void dispose_of_all();

}  // namespace simbench
