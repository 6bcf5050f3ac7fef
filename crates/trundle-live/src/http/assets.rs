//! The files of the page, as `npm run build` in `page/` writes them.

use axum::http::{StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};

/// Path, type and bytes of each file.
const FILES: [(&str, &str, &[u8]); 4] = [
    ("/", "text/html; charset=utf-8", include_bytes!("../../assets/index.html")),
    ("/page.js", "text/javascript; charset=utf-8", include_bytes!("../../assets/page.js")),
    ("/page.css", "text/css; charset=utf-8", include_bytes!("../../assets/page.css")),
    ("/icon.svg", "image/svg+xml", include_bytes!("../../assets/icon.svg")),
];

/// The file of a path.
pub async fn file(uri: Uri) -> Response {
    match FILES.iter().find(|(path, ..)| *path == uri.path()) {
        Some((_, kind, bytes)) => ([(header::CONTENT_TYPE, *kind)], *bytes).into_response(),
        None => (StatusCode::NOT_FOUND, "no such file").into_response(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_small() {
        let bytes: usize = FILES.iter().map(|(.., bytes)| bytes.len()).sum();
        assert!(bytes < 300_000, "{bytes} bytes");
    }
}
