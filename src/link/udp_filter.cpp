#include "link/udp_filter.h"

#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>

#include <array>
#include <vector>

#include "base/error.h"

namespace eye {
namespace {

constexpr uint32_t kWholeDatagram = 0xffffffff, kNothing = 0;
constexpr uint32_t kSourcePortOffset = 0;      // in the UDP header (RFC 768), at which the system begins counting
constexpr uint32_t kSourceAddressOffset = 12;  // in the IPv4 header (RFC 791)
constexpr size_t kHeaderBytes = 8;             // UDP's; what is sent lies behind it

// A program for the system (classic BPF). Loaded values are in the machine's byte order, as a peer's are.
class Program {
 public:
  void load(unsigned kind, uint32_t offset) { add(BPF_LD | kind, offset); }
  void mask(uint32_t bits) { add(BPF_ALU | BPF_AND | BPF_K, bits); }
  void end(uint32_t bytes) { add(BPF_RET | BPF_K, bytes); }
  // Goes on behind the next `skipped` instructions where the test is true, or where it is false.
  void skipIf(unsigned test, uint32_t value, size_t skipped) { jump(test, value, skipped, 0); }
  void skipUnless(unsigned test, uint32_t value, size_t skipped) { jump(test, value, 0, skipped); }

  size_t size() const { return code_.size(); }
  bool attachTo(int fd) {
    const sock_fprog filter{static_cast<uint16_t>(code_.size()), code_.data()};
    return setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof(filter)) == 0;
  }

 private:
  void add(unsigned code, uint32_t value) { code_.push_back({static_cast<uint16_t>(code), 0, 0, value}); }
  void jump(unsigned test, uint32_t value, size_t ifTrue, size_t ifFalse) {
    EYE_CHECK(ifTrue <= UINT8_MAX && ifFalse <= UINT8_MAX);
    code_.push_back({static_cast<uint16_t>(BPF_JMP | test | BPF_K), static_cast<uint8_t>(ifTrue),
                     static_cast<uint8_t>(ifFalse), value});
  }

  std::vector<sock_filter> code_;
};

void dropUnlessFrom(const Peer& sender, Program& program) {
  program.load(BPF_H | BPF_ABS, kSourcePortOffset);
  program.skipUnless(BPF_JEQ, sender.port, 2);
  program.load(BPF_W | BPF_ABS, static_cast<uint32_t>(SKF_NET_OFF) + kSourceAddressOffset);
  program.skipIf(BPF_JEQ, sender.address, 1);
  program.end(kNothing);
}

// Takes what has the shape; goes on behind it with what has not.
void takeIfLike(const DatagramShape& shape, Program& program) {
  constexpr size_t kLengthInstructions = 3, kWordInstructions = 4, kTakeInstructions = 1;
  const size_t endAt =
      program.size() + kLengthInstructions + kWordInstructions * shape.words.size() + kTakeInstructions;
  const auto leave = [&] { return endAt - program.size() - 1; };  // from the jump that is added next
  program.load(BPF_W | BPF_LEN, 0);
  program.skipUnless(BPF_JGE, static_cast<uint32_t>(kHeaderBytes + shape.leastBytes), leave());
  program.skipIf(BPF_JGT, static_cast<uint32_t>(kHeaderBytes + shape.mostBytes), leave());
  for (const WordRange& range : shape.words) {
    // Loading what is not there would end the program.
    EYE_CHECK(range.offset + sizeof(uint32_t) <= shape.leastBytes);
    program.load(BPF_W | BPF_ABS, static_cast<uint32_t>(kHeaderBytes + range.offset));
    program.mask(range.mask);
    program.skipUnless(BPF_JGE, range.least, leave());
    program.skipIf(BPF_JGT, range.most, leave());
  }
  program.end(kWholeDatagram);
  EYE_CHECK(program.size() == endAt);
}

}  // namespace

bool admitOnly(int fd, const std::optional<Peer>& sender, std::span<const DatagramShape> shapes) {
  Program program;
  if (sender) dropUnlessFrom(*sender, program);
  for (const DatagramShape& shape : shapes) takeIfLike(shape, program);
  program.end(shapes.empty() ? kWholeDatagram : kNothing);
  return program.attachTo(fd);
}

void admitEveryone(int fd) {
  const int unused = 0;
  setsockopt(fd, SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof(unused));
}

uint32_t droppedOf(int fd) {
  std::array<uint32_t, SK_MEMINFO_VARS> counts{};
  socklen_t bytes = sizeof(counts);
  return getsockopt(fd, SOL_SOCKET, SO_MEMINFO, counts.data(), &bytes) == 0 ? counts[SK_MEMINFO_DROPS] : 0;
}

}  // namespace eye
