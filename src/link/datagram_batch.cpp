#include "link/datagram_batch.h"

namespace eye {

DatagramBatch::DatagramBatch()
    : bytes_(std::make_unique_for_overwrite<std::byte[]>(kBatchDatagrams * kMaxDatagramBytes)) {
  for (size_t i = 0; i < kBatchDatagrams; ++i) {
    places_[i] = {bytes_.get() + i * kMaxDatagramBytes, kMaxDatagramBytes};
    headers_[i].msg_hdr.msg_name = &senders_[i];
    headers_[i].msg_hdr.msg_iov = &places_[i];
    headers_[i].msg_hdr.msg_iovlen = 1;
  }
}

std::span<const Datagram> DatagramBatch::receive(const UdpSocket& socket) {
  for (mmsghdr& header : headers_) header.msg_hdr.msg_namelen = sizeof(sockaddr_in);  // the system overwrites it
  const size_t count = socket.receiveMany(headers_);
  for (size_t i = 0; i < count; ++i) {
    const Peer sender{ntohl(senders_[i].sin_addr.s_addr), ntohs(senders_[i].sin_port)};
    datagrams_[i] = {{bytes_.get() + i * kMaxDatagramBytes, headers_[i].msg_len}, sender};
  }
  return std::span(datagrams_).first(count);
}

}  // namespace eye
