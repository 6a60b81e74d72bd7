// name: sanitizers
// kind: table
// description: Which sanitizers clean which kind of data, how, and who else reads the same channels uncleaned?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns sanitizer: string, name of the sanitizer
// returns category: string, a kind of data that it cleans: one that its label names, or one that gets to it
// returns gets: boolean, whether data of that kind gets to it
// returns method: string, anonymise, aggregate, drop or pseudonymise; the last leaves personal data
// returns stated: boolean, whether the label states the method
// returns label: string, file:line of the label that decides
// returns channels: list of string, channels from which it reads the category and that others read too
// returns others: list of string, who gets the category from these channels beside it
// order: robot, sanitizer, category
MATCH (:DataCategory)<-[:SANITIZES]-(e:Element)
WHERE $robot = '' OR e.robot = $robot
WITH DISTINCT e
WITH e, COLLECT { MATCH ()-[i:FLOWS_TO]->(e)
                  UNWIND coalesce(i.passes, []) + coalesce(i.begins, []) + coalesce(i.made, []) AS kind
                  RETURN DISTINCT kind } AS arriving,
     COLLECT { MATCH (e)-[:SANITIZES]->(c:DataCategory) RETURN DISTINCT c.name } AS named
UNWIND [k IN e.sanitizes WHERE k IN arriving OR k IN named] AS kind
CALL (e, kind) {
  MATCH (e)-[s:SANITIZES]->(:DataCategory)<-[up:BROADER*0..]-(:DataCategory {name: kind})
  WITH s, up, coalesce(s.stated, s.method IS NOT NULL) AS stated, coalesce(s.file + ':' + s.line, 'by hand') AS label
  ORDER BY coalesce(s.tier, 2) DESC, coalesce(s.specificity, 1000000) DESC, coalesce(s.every, false), size(up), stated,
           label LIMIT 1
  RETURN coalesce(s.method, 'pseudonymise') AS method, stated, label
}
CALL (e, kind) {
  MATCH (channel:Topic|Service|Action)-[f:FLOWS_TO WHERE kind IN f.passes]->()
        ((:Wildcard)-[g:FLOWS_TO WHERE kind IN g.passes]->()){0,1}(e)
  WITH DISTINCT e, kind, channel
  MATCH (channel)-[f:FLOWS_TO WHERE kind IN f.passes]->()
        ((:Wildcard)-[g:FLOWS_TO WHERE kind IN g.passes]->()){0,1}(o:Element WHERE NOT o:Topic|Service|Action)
  WHERE o <> e
  RETURN channel.name AS channel, o.name AS other
UNION
  RETURN null AS channel, null AS other
}
WITH e, kind, arriving, method, stated, label, channel, other ORDER BY channel
WITH e, kind, kind IN arriving AS gets, method, stated, label, collect(DISTINCT channel) AS channels,
     collect(other) AS names
CALL (names) {
  UNWIND names AS other
  WITH DISTINCT other ORDER BY other
  RETURN collect(other) AS others
}
RETURN e.robot AS robot, e.name AS sanitizer, kind AS category, gets, method, stated, label, channels, others
ORDER BY robot, sanitizer, category
