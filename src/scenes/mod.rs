//! Built-in surfaces, lights and the renderer that tests, tables and the page share.
