// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iostream>
#include <limits>

#include "MMMConverterS2KF/commands/commands.h"
#include "MMMConverterS2KF/commands/request_options.h"
#include "MMMConverterS2KF/terminal/command_line.h"
#include "MMMConverterS2KF/terminal/interruption.h"
#include "MMMConverterS2KF/terminal/log.h"
#include "common/live/natnet/natnet_server.h"
#include "common/live/qtm/qtm_server.h"
#include "common/live/stream_address.h"
#include "common/math/up_axis.h"
#include "common/pipeline/input/input.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

const std::vector<OptionGroup> kOwnOptions = {
    {"System",
     {{"as", "qtm|natnet", "qtm (Qualisys QTM) or natnet (OptiTrack Motive); needed", ""},
      {"protocol", "VERSION",
       "qtm: the newest version that is accepted, 1.8 to 1.28, default 1.28; natnet: the version "
       "that is spoken, 2.5 to 4.2, default 4.1",
       ""},
      {"stream-up", "AXIS",
       "the axis that points up in what is streamed: x, y, z, -x, -y or -z; default: z for qtm, y "
       "for natnet",
       ""}}},
    {"Network",
     {{"port", "PORT",
       "qtm: TCP, default 22223; natnet: commands, UDP, default 1510; 0: any that is free", ""},
      {"bind", "ADDRESS",
       "address of this computer that is served, 0.0.0.0 for all; default: 127.0.0.1, this "
       "computer "
       "only",
       ""},
      {"multicast", "GROUP", "natnet: stream to this group, such as 239.255.42.99; else unicast",
       ""},
      {"data-port", "PORT", "natnet: of the frames by multicast, default 1511", ""},
      {"discovery", "", "qtm: answer clients that look for QTM in the network (UDP 22226)", ""}}},
    {"Playing",
     {{"speed", "FACTOR", "of the recording's time, or max: as fast as clients take it; default: 1",
       ""},
      {"loop", "", "begin again at the end", ""}}}};

constexpr const char* kServeUsage = R"(MMMConverterS2KF serve RECORDING --as qtm|natnet [options]
Plays a recording as a motion capture system streams what its cameras see, for programs that take
such a stream and have no cameras. It begins with the first client that asks for frames (multicast:
at once) and, where it has ended, with the next one; Ctrl-C ends it. Missing markers are missing in
the stream, too.

{}Examples
  MMMConverterS2KF serve walk.c3d --as qtm
  MMMConverterS2KF serve walk.c3d --as natnet --loop --protocol 3.0
  MMMConverterS2KF serve walk.c3d --as qtm --bind 0.0.0.0 --discovery --speed 0.5
  MMMConverterS2KF serve walk.c3d --as natnet --bind 192.168.1.5 --multicast 239.255.42.99
)";

PlaybackOptions MakePlayback(const Arguments& arguments) {
  PlaybackOptions playback;
  playback.loop = arguments.Has("loop");
  if (arguments.Get("speed") == "max") {
    playback.speed = 0;
  } else if (const auto speed = arguments.GetNumber("speed", "times the recording's, or max")) {
    if (*speed < 1e-3 || *speed > 1e3) {
      throw UsageError(fmt::format("--speed is {}; it must be 0.001 to 1000, or max", *speed));
    }
    playback.speed = *speed;
  }
  return playback;
}

int PortOf(const Arguments& arguments, const std::string& name, int otherwise) {
  return arguments.GetInteger(name, 0, std::numeric_limits<std::uint16_t>::max())
      .value_or(otherwise);
}

UpAxis StreamUpOf(const Arguments& arguments, UpAxis otherwise) {
  const auto axis = arguments.Get("stream-up");
  return axis ? ParseUpAxis(*axis) : otherwise;
}

/// @throws UsageError where an option is given that the other system has.
void AllowNone(const Arguments& arguments, const std::vector<std::string>& names,
               const std::string& system) {
  for (const std::string& name : names) {
    if (arguments.Has(name)) {
      throw UsageError(fmt::format("--{} is only for --as {}", name, system));
    }
  }
}

QtmServerOptions MakeQtmOptions(const Arguments& arguments) {
  AllowNone(arguments, {"multicast", "data-port"}, "natnet");
  QtmServerOptions options;
  options.address = arguments.Get("bind").value_or(options.address);
  options.port = PortOf(arguments, "port", options.port);
  options.up_axis = StreamUpOf(arguments, options.up_axis);
  options.playback = MakePlayback(arguments);
  if (arguments.Has("discovery")) options.discovery_port = kQtmDiscoveryPort;
  if (const auto version = arguments.Get("protocol")) {
    const auto minor = version->starts_with("1.") ? ParseLong(version->substr(2)) : std::nullopt;
    if (!minor || *minor < kOldestQtmMinor || *minor > kNewestQtmMinor) {
      throw UsageError(fmt::format("--protocol is {}; of QTM it must be 1.{} to 1.{}", *version,
                                   kOldestQtmMinor, kNewestQtmMinor));
    }
    options.newest_minor = static_cast<int>(*minor);
  }
  return options;
}

NatNetServerOptions MakeNatNetOptions(const Arguments& arguments, const std::string& subject) {
  AllowNone(arguments, {"discovery"}, "qtm");
  NatNetServerOptions options;
  options.address = arguments.Get("bind").value_or(options.address);
  options.command_port = PortOf(arguments, "port", options.command_port);
  options.data_port = PortOf(arguments, "data-port", options.data_port);
  options.group = arguments.Get("multicast").value_or("");
  options.up_axis = StreamUpOf(arguments, options.up_axis);
  options.playback = MakePlayback(arguments);
  if (!subject.empty()) options.asset = subject;
  if (const auto version = arguments.Get("protocol")) {
    try {
      options.version = ParseNatNetVersion(*version);
    } catch (const Error& error) {
      throw UsageError(fmt::format("--protocol: {}", error.what()));
    }
  }
  return options;
}

std::string Describe(const MarkerSequence& markers) {
  return fmt::format("{} markers, {} frames at {:g} Hz", markers.num_labels(), markers.num_frames(),
                     markers.rate());
}

/// What a client on this computer connects to.
std::string HostOf(const std::string& address) {
  return address == "0.0.0.0" ? "127.0.0.1" : InAddress(address);
}

template <typename Server>
int Run(Server* server, const std::string& what, const std::string& address) {
  constexpr std::chrono::milliseconds kPatience{200};
  std::cout << what << "\nClients connect to " << address << "; Ctrl-C ends this\n" << std::flush;
  const InterruptionWatch watch;
  bool had_ended = false;
  while (InterruptionWatch::Signal() == 0) {
    server->Step(kPatience);
    const bool has_ended = server->playback().has_ended();
    if (has_ended && !had_ended) LogInfo("played to the end; begins again with the next client");
    had_ended = has_ended;
  }
  server->Shutdown();
  std::cout << fmt::format("Ended after {} frames\n", server->playback().taken());
  return 0;
}

}  // namespace

Manual ServeManual() { return {kServeUsage, CommandOptions(task::kServe, kOwnOptions)}; }

int RunServe(const Arguments& arguments) {
  if (!arguments.positional()) {
    throw UsageError(
        "serve: which recording? For instance: MMMConverterS2KF serve walk.c3d --as qtm");
  }
  StartLog(arguments.Get("log").value_or("info"));
  if (!arguments.Has("as")) throw UsageError("serve: as which system? --as qtm or --as natnet");
  const bool is_qtm = arguments.GetChoice("as", {"qtm", "natnet"}, "qtm") == "qtm";
  Warnings warnings;
  InputRequest request = MakeRequest(task::kServe, arguments, *arguments.positional()).input;
  request.reading.with_unlabelled = true;
  Recording recording = ReadInput(request, {}, &warnings).recording;
  LogWarnings(warnings);
  const std::string described = Describe(recording.markers);
  if (is_qtm) {
    const QtmServerOptions options = MakeQtmOptions(arguments);
    QtmServer server(std::move(recording.markers), options);
    return Run(&server,
               fmt::format("{} is played as QTM ({}), protocol up to 1.{}", recording.file,
                           described, options.newest_minor),
               fmt::format("qtm://{}:{}", HostOf(options.address), server.port()));
  }
  const NatNetServerOptions options = MakeNatNetOptions(arguments, recording.subject);
  NatNetServer server(std::move(recording.markers), options);
  return Run(
      &server,
      fmt::format("{} is streamed as by Motive ({}), NatNet {}, {}", recording.file, described,
                  Format(options.version),
                  options.group.empty() ? "unicast" : "to " + options.group),
      fmt::format(
          "natnet://{}:{}{}", HostOf(options.address), server.command_port(),
          options.up_axis == UpAxis::kY ? "" : fmt::format("?up={}", Name(options.up_axis))));
}

}  // namespace mmm_converter
