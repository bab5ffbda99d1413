# Writes OUTPUT: the page of the report (FOLDER) and uPlot (UPLOT) as the C++ source behind
# reports/page/web_files.h. Run by the build whenever one of the files has changed.
#
# The script is one module: what others use comes first.
set(script "")
foreach(name data axes overlay chart photographs figure_view report)
  file(READ ${FOLDER}/${name}.js text)
  string(APPEND script "${text}\n")
endforeach()
file(READ ${FOLDER}/report.html page)
file(READ ${FOLDER}/report.css style)
file(READ ${UPLOT}/dist/uPlot.iife.min.js uplot_script)
file(READ ${UPLOT}/dist/uPlot.min.css uplot_style)
file(READ ${UPLOT}/LICENSE uplot_licence)

file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "reports/page/web_files.h"

namespace simbench::reports::web {

std::string_view page() { return R"embedded(@page@)embedded"; }
std::string_view style() { return R"embedded(@style@)embedded"; }
std::string_view script() { return R"embedded(@script@)embedded"; }
std::string_view uplot_script() { return R"embedded(@uplot_script@)embedded"; }
std::string_view uplot_style() { return R"embedded(@uplot_style@)embedded"; }
std::string_view uplot_licence() { return R"embedded(@uplot_licence@)embedded"; }

}  // namespace simbench::reports::web
]])
