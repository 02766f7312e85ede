//! Access control: only pages of this server, with the token of this start, are admitted.
//!
//! Listening on the loopback address alone does not exclude pages of other sites, because a browser on this computer
//! sends the requests of such a page. `Host` reveals a domain name that was made to point here, `Origin` a foreign
//! page, and neither knows the token.

use std::sync::Arc;

use axum::body::Body;
use axum::extract::State;
use axum::http::header::{CONNECTION, HOST, HeaderName, HeaderValue, ORIGIN};
use axum::http::{HeaderMap, Request, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use super::connections::Admission;

/// Length of the token [bytes].
const LENGTH: usize = 16;

/// Headers of every response.
const HEADERS: [(&str, &str); 6] = [
    (
        "content-security-policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self'; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    ("x-content-type-options", "nosniff"),
    ("referrer-policy", "no-referrer"),
    ("cross-origin-resource-policy", "same-origin"),
    ("cross-origin-opener-policy", "same-origin"),
    ("cache-control", "no-store"),
];

/// Admission criteria of a server.
pub struct Guard {
    token: String,
    /// Accepted values of `Host`.
    hosts: [String; 2],
}

impl Guard {
    /// Creates a guard with a new token, for a server on `port`.
    ///
    /// # Errors
    /// If the system has no random numbers.
    pub fn new(port: u16) -> Result<Self, getrandom::Error> {
        let mut words = [0; LENGTH];
        getrandom::fill(&mut words)?;
        let token = words.iter().map(|word| format!("{word:02x}")).collect();
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
        Ok(Guard { token, hosts })
    }

    /// Returns the page's URL.
    pub fn url(&self) -> String {
        format!("http://{}{}/", self.hosts[0], self.path())
    }

    /// Returns the path prefix of all resources.
    pub fn path(&self) -> String {
        format!("/{}", self.token)
    }

    /// Returns the reason why a request is refused, if it is.
    fn refusal(&self, headers: &HeaderMap, path: &str) -> Option<&'static str> {
        let mut hosts = headers.get_all(HOST).iter();
        let is_own = |host: &HeaderValue| self.hosts.iter().any(|own| host == own.as_str());
        if !hosts.next().is_some_and(is_own) || hosts.next().is_some() {
            return Some("the request is for another host");
        }
        let is_own = |origin: &HeaderValue| {
            let host = origin.to_str().ok().and_then(|origin| origin.strip_prefix("http://"));
            host.is_some_and(|host| self.hosts.iter().any(|own| host == own))
        };
        if !headers.get_all(ORIGIN).iter().all(is_own) {
            return Some("the request comes from a page of another site");
        }
        let token = path.trim_start_matches('/').split('/').next().unwrap_or_default();
        if !same(token, &self.token) {
            return Some("the address has not the token of this start");
        }
        None
    }
}

/// Compares two texts in constant time.
fn same(one: &str, other: &str) -> bool {
    let differences = one.bytes().zip(other.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
    one.len() == other.len() && differences == 0
}

/// Admits a request and its connection, or answers it with 403 and closes the connection.
pub async fn check(
    State(guard): State<Arc<Guard>>,
    request: Request<Body>,
    next: Next,
) -> Response {
    let mut response = match guard.refusal(request.headers(), request.uri().path()) {
        Some(why) => {
            (StatusCode::FORBIDDEN, [(CONNECTION, "close")], format!("{why}\n")).into_response()
        }
        None => {
            if let Some(admission) = request.extensions().get::<Admission>() {
                admission.admit();
            }
            next.run(request).await
        }
    };
    for (name, value) in HEADERS {
        let (name, value) = (HeaderName::from_static(name), HeaderValue::from_static(value));
        response.headers_mut().insert(name, value);
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(pairs: &[(HeaderName, &'static str)]) -> HeaderMap {
        let value = |(name, value): &(HeaderName, &'static str)| {
            (name.clone(), HeaderValue::from_static(value))
        };
        pairs.iter().map(value).collect()
    }

    #[test]
    fn only_a_page_of_this_start_is_let_in() {
        let guard = Guard::new(8080).unwrap();
        let path = guard.path() + "/state";
        let refused = |pairs: &[_], path: &str| guard.refusal(&headers(pairs), path).is_some();
        let own = || (HOST, "127.0.0.1:8080");
        assert!(!refused(&[own()], &path));
        assert!(!refused(&[(HOST, "localhost:8080"), (ORIGIN, "http://localhost:8080")], &path));
        for host in
            ["127.0.0.1", "127.0.0.1:80", "evil.example:8080", "127.0.0.1:8080.evil.example"]
        {
            assert!(refused(&[(HOST, host)], &path), "{host}");
        }
        assert!(refused(&[], &path), "no host");
        let origins =
            ["null", "http://evil.example", "https://127.0.0.1:8080", "http://127.0.0.1:81"];
        for origin in origins {
            assert!(refused(&[own(), (ORIGIN, origin)], &path), "{origin}");
        }
        let longer = guard.path() + "0/state";
        let other = Guard::new(8080).unwrap().path();
        for path in ["/", "/state", &longer, &other, &path[..20]] {
            assert!(refused(&[own()], path), "{path}");
        }
    }
}
