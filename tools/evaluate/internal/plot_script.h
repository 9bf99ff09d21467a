// These functions run a script that draws plots from tables which this program has written.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace leonav {

// Makes the folder if needed. Throws std::runtime_error.
std::filesystem::path make_plot_folder(const std::string& path);

// Runs the script `name` in the folder of this program, with the program's output streams. Throws
// std::runtime_error, which names `tables`, the folder of the tables.
void run_plot_script(const std::string& name, const std::vector<std::string>& words,
                     const std::filesystem::path& tables);

}  // namespace leonav
