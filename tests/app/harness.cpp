#include "harness.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

void redirect(int descriptor, const fs::path& file) {
    dup2(open(file.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), descriptor);
}

[[noreturn]] void execute(const fs::path& folder, const std::vector<std::string>& arguments) {
    std::vector<char*> argv = {const_cast<char*>("keyhole")};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    if (chdir(folder.c_str()) == 0) execv(KEYHOLE_COMMAND, argv.data());
    _exit(127);
}

}  // namespace

const char* const room_scene = R"(<scene version="3.0.0">
  <default name="light" value="5"/>
  <integrator type="path"><integer name="max_depth" value="5"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="60"/>
    <transform name="to_world"><lookat origin="0, 0, 0.95" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm">
      <integer name="width" value="16"/>
      <integer name="height" value="16"/>
      <rfilter type="box"/>
    </film>
  </sensor>
  <shape type="cube">
    <boolean name="flip_normals" value="true"/>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.6, 0.7"/></bsdf>
  </shape>
  <shape type="sphere">
    <point name="center" x="-0.4" y="-0.5" z="0"/>
    <float name="radius" value="0.3"/>
    <bsdf type="dielectric"/>
  </shape>
  <shape type="sphere">
    <point name="center" x="0.4" y="-0.5" z="-0.2"/>
    <float name="radius" value="0.3"/>
    <bsdf type="conductor"/>
  </shape>
  <shape type="rectangle">
    <transform name="to_world">
      <scale value="0.4"/>
      <rotate x="1" angle="90"/>
      <translate y="0.99"/>
    </transform>
    <emitter type="area"><rgb name="radiance" value="$light"/></emitter>
  </shape>
</scene>
)";

std::vector<std::string> quick_render(const std::string& scene, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"render", scene, "-n", "4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::find(more.begin(), more.end(), "--integrator") == more.end())
        arguments.insert(arguments.end(), {"--chains", "64", "--bootstrap", "4096"});
    const auto is_mix = [](const std::string& a) { return a == "--mix" || a == "--like" || a == "--integrator"; };
    if (std::none_of(more.begin(), more.end(), is_mix)) arguments.insert(arguments.end(), {"--mix", "mmlt"});
    return arguments;
}

Process::Process(const fs::path& folder, const std::vector<std::string>& arguments,
                 const std::function<void()>& prepare)
    : logs_(folder.parent_path()), pid_(fork()) {
    if (pid_ != 0) return;
    redirect(STDIN_FILENO, "/dev/null");
    redirect(STDOUT_FILENO, logs_ / "out");
    redirect(STDERR_FILENO, logs_ / "err");
    if (prepare) prepare();
    execute(folder, arguments);
}

Process::~Process() {
    if (!running()) return;
    signal(SIGKILL);
    wait();
}

bool Process::running() {
    if (!finished_) finished_ = waitpid(pid_, &status_, WNOHANG) == pid_;
    return !finished_;
}

bool Process::wait_until(const std::function<bool()>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (running() && std::chrono::steady_clock::now() < deadline) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

void Process::signal(int number) const { kill(pid_, number); }

std::string Process::err() const { return contents(logs_ / "err"); }

Finished Process::wait() {
    if (!finished_) waitpid(pid_, &status_, 0);
    finished_ = true;
    const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    return {code, contents(logs_ / "out"), err()};
}

CommandTest::CommandTest() {
    std::string pattern = (fs::temp_directory_path() / "keyhole-XXXXXX").string();
    root_ = mkdtemp(pattern.data());
    folder_ = root_ / "work";
    fs::create_directory(folder_);
}

CommandTest::~CommandTest() { fs::remove_all(root_); }

std::string CommandTest::write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return name;
}

nlohmann::json CommandTest::json(const std::string& name) const { return nlohmann::json::parse(contents(path(name))); }

Finished CommandTest::run(const std::vector<std::string>& arguments) const {
    return Process(folder_, arguments).wait();
}

std::vector<std::string> CommandTest::files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace keyhole
