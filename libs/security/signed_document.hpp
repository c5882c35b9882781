// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/security/certificates.hpp"

namespace palpate::security {

/// `text` as an S/MIME message signed by `authority`, readable as it is (DDS Security 1.1, section
/// 9.4.1). Throws RunError where OpenSSL fails.
std::string SignDocument(const std::string& text, const Credentials& authority);

/// The text of a signed document, with line ends "\n". Throws InputError where it is none, was
/// changed after it was signed, or is signed by another key than that of the certificate.
std::string VerifiedDocument(const std::string& document, const std::string& authority_pem);

}  // namespace palpate::security
