// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.

export interface Calls {
  readonly "studio.about": { readonly ask: AboutAsk; readonly answer: About };
}

export interface Channels {
}

export interface AboutAsk {
}

export interface About {
  readonly version: string;
  readonly project: string;
  readonly sources: readonly string[];
}
