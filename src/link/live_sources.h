// The live hosts, each from its URL; `rest` is what is behind "scheme://".
#pragma once

#include "link/state_source.h"

namespace eye {

using OpenedSource = Result<std::unique_ptr<StateSource>>;

OpenedSource openNativeFdm(const std::string& url, const std::string& rest);
OpenedSource openCigi(const std::string& url, const std::string& rest, const OpenProbe& openProbe);
OpenedSource openDis(const std::string& url, const std::string& rest);
OpenedSource openXplane(const std::string& url, const std::string& rest);

}  // namespace eye
