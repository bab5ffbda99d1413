# Writes OUTPUT: the pages (FOLDER) and uPlot (UPLOT) as the C++ source behind
# reports/page/web_files.h. Run by the build whenever one of the files has changed.

# The script of a page is one module: what others use comes first.
function(join_modules result)
  set(script "")
  foreach(name ${ARGN})
    file(READ ${FOLDER}/${name}.js text)
    string(APPEND script "${text}\n")
  endforeach()
  set(${result} "${script}" PARENT_SCOPE)
endfunction()
set(figure_modules data axes overlay chart photographs downloads table_values print tables figure_view
             chart_svg figure_svg overview_svg figure_files)
join_modules(script ${figure_modules} report)
join_modules(explore_script ${figure_modules} scale states server stored parameters
             world_view explore)
join_modules(watch_script ${figure_modules} history watch)
foreach(name report explore watch)
  file(READ ${FOLDER}/${name}.html ${name}_page)
  file(READ ${FOLDER}/${name}.css ${name}_style)
endforeach()
file(READ ${UPLOT}/dist/uPlot.iife.min.js uplot_script)
file(READ ${UPLOT}/dist/uPlot.min.css uplot_style)
file(READ ${UPLOT}/LICENSE uplot_licence)

file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "reports/page/web_files.h"

namespace simbench::reports::web {

std::string_view page() { return R"embedded(@report_page@)embedded"; }
std::string_view style() { return R"embedded(@report_style@)embedded"; }
std::string_view script() { return R"embedded(@script@)embedded"; }
std::string_view explore_page() { return R"embedded(@explore_page@)embedded"; }
std::string_view explore_style() { return R"embedded(@explore_style@)embedded"; }
std::string_view explore_script() { return R"embedded(@explore_script@)embedded"; }
std::string_view watch_page() { return R"embedded(@watch_page@)embedded"; }
std::string_view watch_style() { return R"embedded(@watch_style@)embedded"; }
std::string_view watch_script() { return R"embedded(@watch_script@)embedded"; }
std::string_view uplot_script() { return R"embedded(@uplot_script@)embedded"; }
std::string_view uplot_style() { return R"embedded(@uplot_style@)embedded"; }
std::string_view uplot_licence() { return R"embedded(@uplot_licence@)embedded"; }

}  // namespace simbench::reports::web
]])
