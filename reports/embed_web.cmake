# Writes OUTPUT: the pages (FOLDER) and uPlot (UPLOT) as the C++ source behind
# reports/page/web_files.h. Run by the build whenever one of the files has changed.

# Each script by itself, since compilers need not take longer texts than 64 kB.
file(GLOB scripts ${FOLDER}/*.js)
set(modules "")
foreach(script ${scripts})
  cmake_path(GET script STEM name)
  file(READ ${script} text)
  string(APPEND modules
    "constexpr std::string_view k_${name} = R\"embedded(${text}\n)embedded\";\n")
endforeach()

# The script of a page is one module: what others use comes first.
function(join_modules result)
  list(TRANSFORM ARGN PREPEND "k_")
  list(JOIN ARGN ", " names)
  set(${result} "static const std::string joined = join({${names}});\n  return joined;" PARENT_SCOPE)
endfunction()
set(figure_modules data axes overlay chart photographs downloads table_values print tables figure_view
  chart_svg figure_svg overview_svg figure_files)
join_modules(script ${figure_modules} report)
join_modules(explore_script ${figure_modules} scale states server stored parameters world_view explore)
join_modules(watch_script ${figure_modules} history watch)
file(READ ${FOLDER}/head.html head)
foreach(name report explore watch)
  file(READ ${FOLDER}/${name}.html ${name}_page)
  string(REPLACE "{{head}}" "${head}" ${name}_page "${${name}_page}")
  file(READ ${FOLDER}/${name}.css ${name}_style)
endforeach()
file(READ ${UPLOT}/dist/uPlot.iife.min.js uplot_script)
file(READ ${UPLOT}/dist/uPlot.min.css uplot_style)
file(READ ${UPLOT}/LICENSE uplot_licence)

file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "reports/page/web_files.h"

#include <initializer_list>
#include <string>

namespace simbench::reports::web {
namespace {

@modules@
std::string join(std::initializer_list<std::string_view> modules) {
  std::string joined;
  for (const std::string_view module : modules) joined += module;
  return joined;
}

}  // namespace

std::string_view page() { return R"embedded(@report_page@)embedded"; }
std::string_view style() { return R"embedded(@report_style@)embedded"; }
std::string_view script() {
  @script@
}
std::string_view explore_page() { return R"embedded(@explore_page@)embedded"; }
std::string_view explore_style() { return R"embedded(@explore_style@)embedded"; }
std::string_view explore_script() {
  @explore_script@
}
std::string_view watch_page() { return R"embedded(@watch_page@)embedded"; }
std::string_view watch_style() { return R"embedded(@watch_style@)embedded"; }
std::string_view watch_script() {
  @watch_script@
}
std::string_view uplot_script() { return R"embedded(@uplot_script@)embedded"; }
std::string_view uplot_style() { return R"embedded(@uplot_style@)embedded"; }
std::string_view uplot_licence() { return R"embedded(@uplot_licence@)embedded"; }

}  // namespace simbench::reports::web
]])
