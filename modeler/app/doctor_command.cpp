#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include "drivers/transport/diagnosis.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/device_selection.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/table.hpp"

namespace limn::app {

Outcome run_doctor(const DoctorArguments& arguments) {
  const auto listed = in_file("", list_devices());
  if (!listed) return tl::unexpected(listed.error());
  std::vector<ListedDevice> ours;
  std::copy_if(
      listed->begin(), listed->end(), std::back_inserter(ours), [](const ListedDevice& one) {
        return one.backend == Backend::kHidraw || traits_of(one).kind != DeviceKind::kOther;
      });
  const auto findings = diagnose(ours);
  constexpr std::array<const char*, 3> kStates = {"good", "notice", "trouble"};
  Table table({{"state", "state"}, {"subject", "subject"}, {"what", "what"}, {"remedy", "remedy"}});
  for (const Finding& finding : findings) {
    table.add({std::string(kStates[static_cast<std::size_t>(finding.state)]), finding.subject,
               finding.what, finding.remedy.empty() ? Cell() : Cell(finding.remedy)});
  }
  if (auto printed = print(table.print(arguments.format)); !printed) return printed;
  const auto troubles = std::count_if(findings.begin(), findings.end(), [](const Finding& f) {
    return f.state == Finding::State::kTrouble;
  });
  if (troubles == 0) return {};
  return in_file(
      "", Expected<void>(fail(ErrorCode::kIo, "",
                              troubles == 1 ? "one thing is in the way"
                                            : std::to_string(troubles) + " things are in the way",
                              "do what the table says")));
}

}  // namespace limn::app
