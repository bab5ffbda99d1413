// The pages and their scripts, embedded by the build (reports/embed_web.cmake): the files of
// reports/web/, and uPlot.
#pragma once

#include <string_view>

namespace simbench::reports::web {

std::string_view page();    // report.html, a template of escaped_text.h
std::string_view style();   // report.css
std::string_view script();  // the .js files, one after another: one module

// What a page that is explored by hand has besides the report's style.
std::string_view explore_page();
std::string_view explore_style();
std::string_view explore_script();

// What a page that is watched has.
std::string_view watch_page();
std::string_view watch_style();
std::string_view watch_script();

std::string_view uplot_script();
std::string_view uplot_style();
std::string_view uplot_licence();

}  // namespace simbench::reports::web
