// The command line. Exit codes: 0 done, 1 failed, 2 wrong input or usage.
#include <CLI/CLI.hpp>
#include <iostream>
#include <new>

#include "cli/command_compare_images.hpp"
#include "cli/commands.hpp"
#include "sardf/error.hpp"

namespace {

constexpr int failed = 1, wrong_input = 2;

// CLI11 only says that a command is missing when the first word is none.
void check_command(const CLI::App& app, int count, char** arguments) {
  const std::string word = count > 1 ? arguments[1] : "-";
  if (word.starts_with("-")) return;
  std::vector<std::string> accepted;
  std::string list;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == word) return;
    accepted.push_back(command->get_name());
    list += (list.empty() ? "" : ", ") + accepted.back();
  }
  throw sardf::Error("there is no command '" + word + "'; accepted are " + list +
                     sardf::did_you_mean(word, accepted));
}

int run(CLI::App& app, int count, char** arguments) {
  try {
    check_command(app, count, arguments);
    app.parse(count, arguments);
    return 0;
  } catch (const CLI::RuntimeError& ended) {
    return ended.get_exit_code();
  } catch (const CLI::ParseError& usage) {
    return app.exit(usage) == 0 ? 0 : wrong_input;
  } catch (const sardf::Failure& failure) {
    std::cerr << "sardf: " << failure.what() << "\n";
    return failed;
  } catch (const sardf::Error& error) {
    std::cerr << "sardf: " << error.what() << "\n";
    return wrong_input;
  } catch (const sardf::Cancelled&) {
    std::cerr << "sardf: cancelled\n";
  } catch (const std::bad_alloc&) {
    std::cerr << "sardf: not enough memory\n";
  } catch (const std::exception& error) {
    std::cerr << "sardf: " << error.what() << "\n";
  }
  return failed;
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app("Models a solid together with what it is made of, by distances.", "sardf");
  app.set_version_flag("--version", std::string("sardf ") + SARDF_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  sardf::catch_interrupt();
  sardf::add_check(app);
  sardf::add_eval(app);
  sardf::add_mesh(app);
  sardf::add_bake(app);
  sardf::add_povray(app);
  sardf::add_stage(app);
  sardf::add_render(app);
  sardf::add_compare(app);
  sardf::add_compare_images(app);
  sardf::add_solve(app);
  sardf::add_schema(app);
  sardf::add_image(app);
  return run(app, count, arguments);
}
